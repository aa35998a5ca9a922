"""An effect's name enters; what it needs, and whether the numerics have its law, leaves."""

from __future__ import annotations

from typing import Any, Final

from lavendersim.engine.effects import EFFECTS, BodyFacts, Facts, PairFacts

BY_NAME: Final = {effect.NAME: effect for effect in EFFECTS}
# A scene in which boxes fall, touch and rub: what is off there, the numerics have switched off.
BUSY: Final[dict[str, Any]] = {
    "bodies": tuple(
        BodyFacts(name, "box", movable=True, spins=True, round=False, size=1.0, least_size=1.0)
        for name in ("a", "b")
    ),
    "pairs": (PairFacts("a", "b", restitution=1.0, compliance=0.0, friction=1.0),) * 2,
    "pair_count": 2,
    "gravity": (0.0, 0.0, -1.0),
}


def needs(name: str) -> tuple[str, ...]:
    """Return what an effect needs, and what that needs, each once; a shape pair needs nothing."""
    found: dict[str, None] = {}
    waiting = [name]
    while waiting:
        for need in getattr(BY_NAME.get(waiting.pop()), "NEEDS", ()):
            if need not in found:
                found[need] = None
                waiting.append(need)
    return tuple(found)


def has_law(name: str, facts: Facts) -> bool:
    """Whether an effect is no law that the numerics exclude: in some scene they would have it."""
    effect = BY_NAME.get(name)
    if effect is None or not hasattr(effect, "CHOSEN_BY"):
        return True
    return bool(effect.wanted(facts._replace(**BUSY)).on)
