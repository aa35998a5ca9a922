"""A measure for every value of an axis."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lavendersim.figures.specs.base import Number, Panel
from lavendersim.quantities.names import AxisName, MeasureName
from lavendersim.quantities.readings import SUMS


class MeasureByName(Panel):
    """A measure for every value of an axis, names or numbers one below the other."""

    READS = SUMS  # beside its measure
    kind: Literal["measure_by_name"]
    measure: MeasureName = Field(description="the measure on the x axis; its largest of several")
    axis: AxisName = Field(description="the swept axis whose values stand on the y axis")
    floor: Number | None = Field(
        default=None, description="numbers below are round-off and drawn at this place"
    )
    factor: Number = Field(default=1.0, description="multiplies the measure for display")
    y_scale: Literal["linear"] = Field(default="linear", description="values stand side by side")
