"""Models of measures of the residual of one step."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.readings import SUMS


class ResidualBySweep(Measure):
    """Residual [m/s] before sweep 1 and after each sweep (a row of numbers) of one step."""

    READS = SUMS
    NO_NUMBER = "no step ends behind that time, or its sweeps are not recorded"
    kind: Literal["residual_by_sweep"]
    after: Seconds = Field(description="the first step that ends after this time [s] is taken")


class FinalResidual(Measure):
    """Residual [m/s] after the last sweep of one step."""

    READS = SUMS
    NO_NUMBER = "no step ends behind that time"
    kind: Literal["final_residual"]
    after: Seconds = Field(description="the first step that ends after this time [s] is taken")
