"""What every panel of a figure has in common: title, axes, the cells it shows, its series.

A kind is a subclass of `Panel` with a field `kind: Literal["its_name"]`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, model_validator

from lavendersim.measures.specs.base import ClosedForm
from lavendersim.measures.specs.selection import Selection
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import AxisName
from lavendersim.quantities.quantity import NumberOrFormula, Quantity, sentence_error
from lavendersim.quantities.readings import Reader

Scale = Literal["linear", "log"]
Number = Annotated[float, Quantity()]


class Ideal(ConfigModel):
    """A closed form or a formula, drawn as a thin dark line through the cells of the panel."""

    closed_form: ClosedForm | None = Field(
        default=None, description="evaluated in every cell shown"
    )
    value: Annotated[float | str, NumberOrFormula()] | None = Field(
        default=None,
        description="or a formula of constants and axes, in the measure's unit: "
        "`5/7 * $g * sin($slope)`",
    )
    label: str = Field(min_length=1, description="its entry in the legend")

    @model_validator(mode="after")
    def _one_reference(self) -> Ideal:
        if (self.value is None) == (self.closed_form is None):
            raise sentence_error("expected exactly one of value, closed_form")
        return self


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
        default=None, description="one colour and marker per value of this axis"
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
