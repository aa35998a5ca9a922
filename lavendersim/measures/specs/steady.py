"""Models of measures of a body that comes to rest, and of the length of a run."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, PairMeasure, Seconds
from lavendersim.quantities.quantity import Direction, Quantity
from lavendersim.quantities.readings import EVERYTHING, SUMS


class SteadyForce(PairMeasure):
    """Normal force [N] on the body at the end of the run."""

    kind: Literal["steady_force"]
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")
    statistic: Literal["mean", "furthest"] = Field(
        default="mean", description="mean of the window, or its value furthest from that mean"
    )


class SteadyTorque(PairMeasure):
    """Mean torque [N m] of contacts on the body about its centre, as the run ends.

    Of normal forces and friction, with the couples of torsional and rolling friction and patches.
    """

    READS = EVERYTHING
    kind: Literal["steady_torque"]
    along: Direction = Field(description="axis, world frame; right-handed; is normalised")
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")


class SteadyPenetration(PairMeasure):
    """Mean of the body's deepest penetration [m] at the end of the run."""

    kind: Literal["steady_penetration"]
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")
    above_slop: bool = Field(
        default=False, description="subtract the slop of the cell's numerics: d - slop [m]"
    )


class MaxPenetration(PairMeasure):
    """Deepest penetration [m] of the body in any step."""

    kind: Literal["max_penetration"]


class SettlingTime(PairMeasure):
    """Time [s] from the first contact until the penetration stays below a threshold."""

    NO_NUMBER = "nothing touches the body, or it is deeper than the threshold until the run ends"
    kind: Literal["settling_time"]
    threshold: Annotated[float, Quantity("m", above=0)] = Field(description="threshold [m]")


class SimulatedDuration(Measure):
    """Simulated time [s] at the last logged step."""

    READS = SUMS
    kind: Literal["simulated_duration"]
