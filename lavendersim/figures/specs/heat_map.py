"""A measure as colours over two axes of the sweep."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lavendersim.figures.specs.base import Number, Panel, Scale
from lavendersim.quantities.names import AxisName, MeasureName
from lavendersim.quantities.readings import SUMS


class HeatMap(Panel):
    """A measure over two axes as colours, with numbers where they fit; hatched where it is NaN."""

    READS = SUMS  # beside its measure
    kind: Literal["heat_map"]
    measure: MeasureName = Field(description="the measure that is shown; of a row its largest")
    axis: AxisName = Field(description="the swept axis on the x axis")
    rows: AxisName = Field(description="the swept axis on the y axis")
    reduce: Literal["max", "min", "mean"] = Field(
        default="max", description="how cells that differ in other axes become one number"
    )
    factor: Number = Field(default=1.0, description="multiplies the values for display")
    colour_scale: Scale = Field(
        default="linear", description="linear or log, of the colours; log leaves out 0 and below"
    )
    colour_label: str = Field(min_length=1, description="of the colours, with unit in brackets")
    x_scale: Literal["linear"] = Field(default="linear", description="values stand side by side")
    y_scale: Literal["linear"] = Field(default="linear", description="values stand side by side")
