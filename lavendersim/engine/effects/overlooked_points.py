"""Overlooked points: those without a row, that a part of a step would lead into another surface.

Which rows a part has is decided before its solve. Once it is solved the points that have none are
looked at, and where one would end inside the part is made again with it, or up to where it meets
(`engine.overlooked_points`). A sphere touches at points through its centre: a push at one turns
none of the others in, and its points are not looked at. One of a compound is a part like any.
"""

from __future__ import annotations

from ..terms import StepTerms
from .decision import Decision, Facts
from .effect import Effect, Fields
from .impact_order import decide as has_parts


def decide(facts: Facts) -> Decision:
    """On when impacts are in order and two bodies may touch at several points."""
    parts = has_parts(facts)
    if not parts.on:
        return Decision(False, f"steps have one part: {parts.reason}")
    of_parts = {body.name for body in facts.bodies if body.parts > 1}
    for pair in facts.pairs:
        if pair.shape_pair in ("rope", "joint", "joint_stop"):
            continue  # of one point
        if "sphere" not in pair.shape_pair or of_parts & {pair.a, pair.b}:
            return Decision(True, f"{pair.a} and {pair.b} may touch at several points")
    return Decision(False, "spheres touch at single points")


EFFECT = Effect(
    name="overlooked_points",
    decide=decide,
    per="contact",
    needs=("impact_order",),
    overhead_with="impact_order",
    step=StepTerms(overlooks=True),
    fields=Fields(
        pair=[("whole", "i8")],  # 1 while every point of its manifold takes part
    ),
)
