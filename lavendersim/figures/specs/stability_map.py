"""How far an axis can go before a bound breaks, as a map over two others."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lavendersim.figures.specs.base import Number, Panel
from lavendersim.measures.specs.selection import Selection
from lavendersim.quantities.names import AxisName, MeasureName
from lavendersim.quantities.readings import SUMS


class StabilityMap(Panel):
    """How far one axis can go before a bound breaks, over two others, as colours with numbers."""

    READS = SUMS  # beside its measure
    kind: Literal["stability_map"]
    axis: AxisName = Field(description="the swept axis on the x axis")
    rows: AxisName = Field(description="the swept axis on the y axis")
    find: Literal["largest", "least"] = Field(
        description="largest or least value of `of` up to which, from its other end, every cell "
        "ran to its end and kept the bound"
    )
    of: AxisName = Field(description="the swept axis whose limit is shown")
    measure: MeasureName = Field(description="the measure that is bounded")
    at_most: Number = Field(description="the bound, in the measure's unit")
    default: Selection = Field(
        default_factory=dict, description="the place to be marked: a value of `axis` or `rows`"
    )
    x_scale: Literal["linear"] = Field(default="linear", description="values stand side by side")
    y_scale: Literal["linear"] = Field(default="linear", description="values stand side by side")
