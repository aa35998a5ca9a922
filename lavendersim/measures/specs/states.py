"""Models of measures of states: components at a time, first passages, fallen bodies, energies."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.names import BodiesName, BodyName
from lavendersim.quantities.quantity import Direction, Quantity, sentence_error
from lavendersim.quantities.readings import POSES, SUMS, VELOCITIES

Reduction = Literal["row", "max", "min", "mean", "sum", "count"]


class _OfBodies(Measure):
    """A number of each of several bodies, reduced to one, or a row of them."""

    READS = POSES

    body: BodyName | None = Field(default=None, description="the body")
    bodies: tuple[BodiesName, ...] = Field(
        default=(),
        description="or several, also arrangements; all movable bodies where neither is given",
    )
    reduce: Reduction = Field(
        default="row",
        description="how the numbers of several bodies become one; `row` keeps them, `count` is of "
        "those that are no NaN",
    )

    @model_validator(mode="after")
    def _one_selection(self) -> Self:
        if self.body is not None and self.bodies:
            raise sentence_error("expected at most one of body, bodies")
        return self

    @property
    def chosen(self) -> tuple[str, ...]:
        """The names that are given; none for all movable bodies."""
        return self.bodies if self.body is None else (self.body,)


class PositionAt(_OfBodies):
    """Component [m] of the centre of mass along a direction, at a time."""

    kind: Literal["position"]
    along: Direction = Field(description="direction, world frame; is normalised")
    time: Seconds | None = Field(
        default=None,
        description="[s] first state then or later; the end of the run when absent",
    )


class _VelocityAt(_OfBodies):
    READS = VELOCITIES
    along: Direction = Field(description="direction, world frame; is normalised")
    time: Seconds | None = Field(
        default=None,
        description="[s] first state then or later; the end of the run when absent",
    )


class VelocityAt(_VelocityAt):
    """Component [m/s] of the velocity of the centre of mass along a direction, at a time.

    As the step that ends then leaves it; takes `record: {velocities: true}`.
    """

    kind: Literal["velocity"]


class AngularVelocityAt(_VelocityAt):
    """Component [rad/s] of the angular velocity along a direction, at a time.

    As the step that ends then leaves it; takes `record: {velocities: true}`.
    """

    kind: Literal["angular_velocity"]


class FirstPassage(_OfBodies):
    """Time [s] at which a component of the centre first crosses a level; NaN where it never does.

    Between two states the component is taken as a straight line.
    """

    NO_NUMBER = "the centre never crosses that level so"
    kind: Literal["first_passage"]
    along: Direction = Field(description="direction, world frame; is normalised")
    level: Annotated[float, Quantity("m")] = Field(description="[m] what is crossed")
    crossing: Literal["rising", "falling", "either"] = Field(
        default="either", description="which crossings count"
    )
    after: Seconds = Field(default=0.0, description="[s] only crossings after this time")


class FallenBodies(Measure):
    """Number [-] of bodies of which an axis has turned away by more than an angle."""

    READS = POSES
    kind: Literal["fallen_bodies"]
    bodies: tuple[BodiesName, ...] = Field(
        default=(),
        description="which are counted, also arrangements; all movable bodies when absent",
    )
    axis: Direction = Field(default=(0.0, 0.0, 1.0), description="axis in the body's frame")
    degrees: Annotated[float, Quantity("degree", above=0, below=180)] = Field(
        default=45.0, description="[degree] from its direction at the start"
    )
    time: Seconds | None = Field(
        default=None,
        description="[s] first state then or later; the end of the run when absent",
    )


class EnergyAt(Measure):
    """A part of the energy [J] of the scene at a time, or by how much it has changed till then."""

    READS = SUMS
    kind: Literal["energy"]
    part: Literal["kinetic", "potential", "mechanical"] = Field(
        default="mechanical",
        description="mechanical is the sum of both and of what springs and contacts store",
    )
    time: Seconds | None = Field(
        default=None,
        description="[s] first state then or later; the end of the run when absent",
    )
    since: Seconds | None = Field(
        default=None, description="[s] a time before: less the energy then, as the work done since"
    )
