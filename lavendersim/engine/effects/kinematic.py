"""Kinematic bodies: they keep their velocity whatever touches them; to contacts they are immovable.

Their inverse mass is 0, as that of fixed bodies; the step moves them all the same (`integrate`).
"""

from typing import Any

from ..terms import StepTerms
from .decision import Decision, Facts, named
from .effect import Balance, Effect, Fields, Unlogged
from .keys import BodyKey


def body_values(body: Any) -> dict[str, bool]:
    """Return the value of the body fields that a config gives a body."""
    return {"kinematic": body.kinematic}


def decide(facts: Facts) -> Decision:
    """On when a body is kinematic."""
    kinematic = [body.name for body in facts.bodies if body.kinematic]
    if kinematic:
        return Decision(True, f"{named(kinematic)}: moves as its velocity says")
    return Decision(False, "no body is kinematic")


EFFECT = Effect(
    name="kinematic",
    decide=decide,
    per="body",
    body_keys=(
        BodyKey(
            name="kinematic",
            type=bool,
            default=False,
            doc="true: keeps its velocity and angular velocity whatever touches it, or moves as "
            "`motion` says; no mass",
            prescribes_motion=True,
        ),
    ),
    step=StepTerms(kinematic=True),
    balance=Balance(unlogged=Unlogged("energy", "{body} moves by itself, and its work")),
    fields=Fields(
        body=[("kinematic", "i8")],  # 1: keeps its velocity
    ),
    body_values=body_values,
)
