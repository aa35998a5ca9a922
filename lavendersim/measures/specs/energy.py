"""Models of measures of the energy of a bouncing body."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure
from lavendersim.quantities.names import BodyName, PlaneName
from lavendersim.quantities.quantity import Quantity

MOST_BOUNCES = 1_000_000  # each has a number, whether the run comes to it or not


class _OverBounces(Measure):
    """A body that bounces on a plane, so many times."""

    body: BodyName = Field(description="the bouncing body; the only movable one")
    above: PlaneName = Field(description="the plane it bounces on; energy is zero at rest on it")
    bounces: Annotated[int, Quantity("", minimum=1, maximum=MOST_BOUNCES, whole=True)] = Field(
        description="how many bounces [-]"
    )


class EnergyByBounce(_OverBounces):
    """Relative change of mechanical energy at the apex after bounce 1, 2, ... (a row)."""

    NO_NUMBER = "the run ends before the last of these bounces"
    kind: Literal["energy_by_bounce"]


class EnergyAfterBounces(_OverBounces):
    """The last number of `energy_by_bounce`."""

    NO_NUMBER = "the run ends before the last of these bounces"
    kind: Literal["energy_after_bounces"]
