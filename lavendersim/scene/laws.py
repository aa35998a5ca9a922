"""An effect's name enters; what it needs, and what chooses its law where one does, leaves."""

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


def choice(name: str) -> tuple[str, str]:
    """Return the section and the key of a config that choose an effect; it is a law."""
    effect = BY_NAME[name]
    return getattr(effect, "CHOSEN_IN", "numerics"), effect.CHOSEN_BY


def is_law(name: str) -> bool:
    """Whether a key of the config chooses an effect, and no coefficient turns it off."""
    return hasattr(BY_NAME.get(name), "CHOSEN_BY")


def has_law(name: str, facts: Facts) -> bool:
    """Whether an effect is no law that the numerics exclude: in some scene they would have it."""
    if not is_law(name):
        return True
    return bool(BY_NAME[name].wanted(facts._replace(**BUSY)).on)
