"""What every panel of a figure has in common: title, axes, the cells it shows, its series.

A kind is a subclass of `Panel` with a field `kind: Literal["its_name"]`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.selection import Selection
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import AxisName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import Reader

Scale = Literal["linear", "log"]
Number = Annotated[float, Quantity()]


class Level(ConfigModel):
    """A constant drawn as a thin dashed line."""

    value: Number = Field(description="where, in the unit of the y axis")
    label: str = Field(min_length=1, description="its entry in the legend")


class Panel(Reader):
    """What every kind of panel may carry."""

    if TYPE_CHECKING:
        kind: str  # of each subclass a Literal of its own

    title: str = Field(default="", description="one idea, above the panel")
    x_label: str = Field(min_length=1, description="x axis, with its unit in brackets")
    y_label: str = Field(min_length=1, description="y axis, with its unit in brackets")
    x_scale: Scale = Field(default="linear", description="linear or log")
    y_scale: Scale = Field(default="linear", description="linear or log")
    at: Selection = Field(default_factory=dict, description="the cells shown; all when absent")
    series: AxisName | None = Field(
        default=None,
        description="one colour and marker per value of this axis; of time series, where cells "
        "differ by one axis, that",
    )
    series_label: str = Field(
        default="", description="legend entry, {} stands for the value: `timestep {} s`"
    )
    levels: tuple[Level, ...] = Field(default=(), description="constants to compare with")
    x_limits: tuple[Number, Number] | None = Field(
        default=None, description="[low, high] shown, in the unit of the x axis"
    )
    y_limits: tuple[Number, Number] | None = Field(
        default=None, description="[low, high] shown, in the unit of the y axis"
    )
