"""What an effect needs, and which key of the config chooses its law where one does."""

from __future__ import annotations

from typing import Any, Final

from lavendersim.cell import Surface
from lavendersim.engine.effects import (
    BY_NAME,
    SURFACE_KEYS,
    BodyFacts,
    Choice,
    Facts,
    PairFacts,
)

# With every property that a surface can have.
SURFACE: Final = Surface(**{key.name: 1.0 for key in SURFACE_KEYS})
# A scene in which boxes fall, touch and slide: what is off there, the numerics have switched off.
BUSY: Final[dict[str, Any]] = {
    "bodies": tuple(
        BodyFacts(name, "box", movable=True, spins=True, round=False, size=1.0, least_size=1.0)
        for name in ("a", "b")
    ),
    "pairs": (PairFacts("a", "b", SURFACE),) * 2,
    "pair_count": 2,
    "gravity": (0.0, 0.0, -1.0),
}


def needs(name: str) -> tuple[str, ...]:
    """Return what an effect needs, and what that needs, each once; a shape pair needs nothing."""
    found: dict[str, None] = {}
    waiting = [name]
    while waiting:
        effect = BY_NAME.get(waiting.pop())
        for need in effect.needs if effect else ():
            if need not in found:
                found[need] = None
                waiting.append(need)
    return tuple(found)


def choice(name: str) -> Choice:
    """Return the key of a config that chooses an effect, and its section; it is a law."""
    chosen = BY_NAME[name].chosen_by
    if chosen is None:
        raise ValueError(f"no key of a config chooses {name}")
    return chosen


def is_law(name: str) -> bool:
    """Whether a key of the config chooses an effect, and no coefficient turns it off."""
    effect = BY_NAME.get(name)
    return effect is not None and effect.chosen_by is not None


def has_law(name: str, facts: Facts) -> bool:
    """Whether an effect is no law that the numerics exclude: in some scene they would have it."""
    if not is_law(name):
        return True
    return bool(BY_NAME[name].decide(facts._replace(**BUSY)).on)
