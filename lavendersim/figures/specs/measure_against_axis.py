"""A measure against a swept axis, on its closed form."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.figures.specs.base import Number, Panel
from lavendersim.figures.specs.ideal import Ideal
from lavendersim.measures.specs.expectation import Aggregate
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import AxisName, MeasureName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import SUMS


class Onset(ConfigModel):
    """A vertical mark where the measure, several cells reduced to one, rises through a level."""

    level: Number = Field(description="the level, in the unit of the y axis")
    reduce: Aggregate = Field(default="mean", description="how several cells become one number")
    label: str = Field(min_length=1, description="text beside the mark")


class MeasureAgainstAxis(Panel):
    """A measure against a swept axis: markers at the mean, a band from min to max of the rest."""

    READS = SUMS  # beside its measure
    kind: Literal["measure_against_axis"]
    measure: MeasureName = Field(description="the measure on the y axis")
    axis: AxisName = Field(description="the swept axis on the x axis")
    ideal: Ideal | None = Field(default=None, description="the closed form it is compared with")
    factor: Number = Field(
        default=1.0, description="multiplies measure and ideal for display (1000: m as mm)"
    )
    x_factor: Number = Field(default=1.0, description="multiplies the axis values for display")
    floor: Number | None = Field(
        default=None, description="numbers below are round-off and drawn at this height"
    )
    onsets: tuple[Onset, ...] = Field(default=(), description="crossings to mark")
    orders: tuple[Annotated[float, Quantity(above=0)], ...] = Field(
        default=(),
        description="slopes drawn for comparison: y as this power of x, through the last point of "
        "the first series [-]",
    )
    proportions: tuple[Annotated[float, Quantity(above=0)], ...] = Field(
        default=(),
        description="lines y = k x drawn for comparison, by their k, in the units drawn [-]",
    )
