"""Models of measures of how bodies move, from the logged poses alone."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.names import BodiesName, BodyName
from lavendersim.quantities.quantity import Quantity, Vector, Vector3, sentence_error
from lavendersim.quantities.readings import POSES

Direction = Annotated[Vector3, Vector(3, Quantity())]


class _OfOneBody(Measure):
    """A measure of one body."""

    body: BodyName = Field(description="the body")


class _Between(Measure):
    """A measure of the motion between two times."""

    READS = POSES

    begin: Seconds = Field(default=0.0, alias="from", description="first time [s]")
    end: Seconds | None = Field(
        default=None, alias="to", description="second time [s]; the end of the run when absent"
    )

    @model_validator(mode="after")
    def _forward(self) -> Self:
        if self.end is not None and self.end <= self.begin:
            raise sentence_error("expected `from` before `to`")
        return self


class _Along(_Between, _OfOneBody):
    """A component of a body's motion between two times."""

    along: Direction = Field(description="direction, world frame; its length does not matter")

    @model_validator(mode="after")
    def _direction(self) -> Self:
        if not any(self.along):
            raise sentence_error("expected a direction `along` that is not zero")
        return self


class Displacement(_Along):
    """How far [m] a body's centre came along a direction, between two times."""

    kind: Literal["displacement"]


class MeanVelocity(_Along):
    """Mean velocity [m/s] of a body's centre along a direction, between two times."""

    kind: Literal["mean_velocity"]


class MeanAngularVelocity(_Along):
    """Mean component [rad/s] of a body's angular velocity along a direction, between two times.

    Turns of neighbouring states are added; each must be less than half a turn.
    """

    kind: Literal["mean_angular_velocity"]


class CentreOfMass(_Between):
    """Component [m] of the common centre of mass of bodies: its mean between two times."""

    kind: Literal["centre_of_mass"]
    bodies: tuple[BodiesName, ...] = Field(
        default=(), description="which, also arrangements; all movable bodies when absent"
    )
    along: Annotated[Vector3, Vector(3, Quantity(), nonzero=True)] = Field(
        description="direction, world frame; its length does not matter"
    )


class TopSpeed(Measure):
    """Greatest speed [m/s] of any centre: displacement between neighbouring states over time."""

    READS = POSES
    kind: Literal["top_speed"]
    after: Seconds = Field(default=0.0, description="[s] only motion after this time")
    bodies: tuple[BodiesName, ...] = Field(
        default=(),
        description="whose centres, also of arrangements; of all movable bodies when absent",
    )


class RestTime(Measure):
    """Time [s] from which on no centre moves faster than a threshold; NaN if one still does."""

    READS = POSES
    NO_NUMBER = "a centre is faster than that until the run ends"
    kind: Literal["rest_time"]
    slower_than: Annotated[float, Quantity("m/s", above=0)] = Field(description="threshold [m/s]")
    bodies: tuple[BodiesName, ...] = Field(
        default=(),
        description="whose centres, also of arrangements; of all movable bodies when absent",
    )


class Tilt(Measure):
    """Angle [degree] between an axis of a body at the end of the run and at its start."""

    READS = POSES
    kind: Literal["tilt"]
    body: BodyName = Field(description="the body")
    axis: Direction = Field(default=(0.0, 0.0, 1.0), description="axis in the body's frame")
