"""Models of the distance of one body from closed forms of rigid motion."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import POSES

# |omega| dt of a step must stay small for a flip to be found between the samples around it
MOST_FLIPS = 1_000_000  # their times are reckoned, however many the log has
Flips = Annotated[int, Quantity("", minimum=1, maximum=MOST_FLIPS, whole=True)]


class VelocityError(Measure):
    """Distance [m/s] from the closed form of one impact, at the end of the run.

    The larger of |v - v*| and rho |omega - omega*|, rho the radius of the body about its centre.
    """

    READS = POSES
    NO_NUMBER = "another body can move, or nothing is hit"
    kind: Literal["velocity_error"]
    body: BodyName = Field(description="the body that hits; the only movable one")
    other: BodyName = Field(description="the plane or fixed body it hits")


class AngularVelocityError(Measure):
    """Largest |omega - omega*| / |omega(0)| [-], body axes, from Jacobi's free rotation."""

    READS = POSES
    NO_NUMBER = "another body can move, or the body does not turn"
    kind: Literal["angular_velocity_error"]
    body: BodyName = Field(description="the free body; the only movable one")
    until: Seconds | None = Field(default=None, description="[s] the whole run when absent")


class FlipTimeError(Measure):
    """Largest distance [s] of a time at which the body flips from that of Jacobi's solution.

    A flip: the component of omega about the axis of the middle moment changes its sign.
    """

    READS = POSES
    NO_NUMBER = "the run has fewer flips"
    kind: Literal["flip_time_error"]
    body: BodyName = Field(description="the free body; the only movable one")
    flips: Flips = Field(description="how many flips are compared, from the first [-]")
