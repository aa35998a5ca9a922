"""A row of numbers against its index."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.figures.specs.base import Number, Panel
from lavendersim.quantities.names import MeasureName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import SUMS


class RowAgainstIndex(Panel):
    """A measure that is a row of numbers (sweeps, bounces) against its index."""

    READS = SUMS  # beside its measure
    kind: Literal["row_against_index"]
    measure: MeasureName = Field(description="the measure on the y axis")
    first_index: Annotated[int, Quantity(whole=True)] = Field(
        default=0, description="index of the row's first number [-]"
    )
    floor: Number | None = Field(
        default=None, description="numbers below are round-off and drawn at this height"
    )
    factor: Number = Field(default=1.0, description="multiplies the measure for display")
