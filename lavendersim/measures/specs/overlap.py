"""Model of the measure of overlap, from poses and shapes alone."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import POSES

Stride = Annotated[int, Quantity("", minimum=1, whole=True)]


class Overlap(Measure):
    """Deepest penetration [m] of any two bodies at the end of the run, from their geometry."""

    READS = POSES
    NO_NUMBER = "the window is longer than the run, or shapes come close whose depth has no formula"
    kind: Literal["overlap"]
    last: Seconds = Field(default=1.0, description="length of the window at the end [s]")
    every: Stride = Field(
        default=1, description="look at every k-th logged step, counted back from the last [-]"
    )
