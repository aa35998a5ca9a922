"""A histogram of a measure over cells."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.figures.specs.base import Number, Panel
from lavendersim.quantities.names import MeasureName
from lavendersim.quantities.readings import SUMS


class Histogram(Panel):
    """How many values of a measure lie where; each value of its rows counts.

    Values that are NaN have no place: the legend says how many there are.
    """

    READS = SUMS  # beside its measure
    kind: Literal["histogram"]
    measure: MeasureName = Field(description="the measure on the x axis")
    bins: Annotated[int, Field(ge=1, le=1000)] | None = Field(
        default=None,
        description="intervals of equal width, of equal ratio on a logarithmic axis; about as many "
        "as the square root of the values when absent",
    )
    count: Literal["values", "share"] = Field(
        default="values", description="on the y axis: values, or the share of them [-] in a bin"
    )
    factor: Number = Field(default=1.0, description="multiplies the measure for display")
    y_scale: Literal["linear"] = Field(default="linear", description="bars begin at 0")
