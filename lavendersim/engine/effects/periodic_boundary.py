"""Periodic boundary: what is near a face of the cell acts on what is near the opposite one.

Along each periodic axis a body has an image a period away on either side (LAMMPS: `boundary p`),
and meets the nearest image of every other. Poses are not wrapped, so that paths and the potential
energy under gravity are continuous. Linear momentum and energy are kept as without a cell. Angular
momentum is not: the two forces of a contact across a face act a period apart, and a force f gives
the torque L x f about any point.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field as ModelField

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity, Vector

from ..terms import StepTerms
from .decision import Decision, Facts
from .effect import Effect, Fields
from .keys import SceneKey

Ends = Annotated[tuple[float, float], Vector(2, Quantity("m"))]
AXES = "xyz"


class Periodic(ConfigModel):
    """The cell: along an axis that is written what leaves at one end comes in at the other."""

    x: Ends | None = ModelField(default=None, description="[m] both ends; none: not periodic")
    y: Ends | None = ModelField(default=None, description="[m] both ends; none: not periodic")
    z: Ends | None = ModelField(default=None, description="[m] both ends; none: not periodic")

    @classmethod
    def rules(cls, at: Any) -> None:
        """Some axis is periodic, and its ends ascend."""
        for axis in AXES:
            ends = [item.number for item in at.get(axis).items]
            if len(ends) == 2 and None not in ends and not ends[0] < ends[1]:
                sentence = f"{axis}: expected the lower end first, found {ends[0]:g}, {ends[1]:g}"
                at.refuse(at.get(axis).mark, sentence)
        if not any(at.written(axis) for axis in AXES):
            at.refuse(at.node.mark, "periodic: expected one of x, y and z, such as x: [0, 1]")

    @property
    def periods(self) -> dict[str, float]:
        """Length of the cell along each periodic axis [m]."""
        ends = {axis: getattr(self, axis) for axis in AXES}
        return {axis: end[1] - end[0] for axis, end in ends.items() if end is not None}


def decide(facts: Facts) -> Decision:
    """On when the scene is periodic and two bodies with images may meet."""
    periodic = None if facts.scene is None else facts.scene.periodic
    if periodic is None:
        return Decision(False, "the scene is not periodic")
    planes = {body.name for body in facts.bodies if body.shape == "plane"}
    if all(pair.a in planes or pair.b in planes for pair in facts.pairs):
        return Decision(False, "bodies meet nothing but planes, which are everywhere")
    axes = " and ".join(periodic.periods)
    return Decision(True, f"the scene is periodic along {axes}")


EFFECT = Effect(
    name="periodic_boundary",
    decide=decide,
    per="contact",
    scene_keys=(
        SceneKey(
            name="periodic",
            type=Periodic | None,
            default=None,
            doc="axes along which the scene repeats itself; none: nowhere",
            resolve=lambda value, turned: value,
        ),
    ),
    step=StepTerms(periodic=True),
    # Length of the cell along each axis, 0 where it is not periodic; of planes 0 [m].
    fields=Fields(body=[(f"period_{axis}", "f8") for axis in AXES]),
)
