"""Joint stop: a hinge turns, and a slider slides, as far as its limits, and stops there.

    phi = r (angle - lower) >= 0,  r (upper - angle) >= 0;   of a slider  s - lower,  upper - s
A stop is a contact without friction that throws nothing back: a peg at the distance r from the
axis, where B's centre is, or at both bodies' radius of gyration as one where that is on the axis.
It pushes both bodies at B's end, across the arm r and the axis, and never pulls; the rows of the
joint take the rest. So its row is that of a contact: solved, projected and judged with them, and
met by an impact in its order. What it carries is part of the joint's force and torque.
"""

from __future__ import annotations

from ..terms import RowTerms
from .decision import Decision, Facts, named
from .effect import Effect, Fields
from .joint_models import holding


def decide(facts: Facts) -> Decision:
    """On when a joint that holds a body that moves has limits."""
    joints = holding(facts.scene) if facts.scene is not None else {}
    limited = [one.name_of_pair for one in joints.values() if one.stop_rows]
    if limited:
        return Decision(True, f"{named(limited)}: limits of a joint")
    return Decision(False, "no joint has limits")


EFFECT = Effect(
    name="joint_stop",
    decide=decide,
    per="contact",
    needs=("joint",),
    row=RowTerms(stopped=True),
    fields=Fields(contact=[("stop", "i8")]),  # 1: of a limit of a joint, at no surface
)
