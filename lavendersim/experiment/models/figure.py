"""The `figure` section of a config in; a validated FigureSpec out.

A figure is one or more panels side by side with a caption beneath that says what to see. Panels
show measures and logged columns; the ideal is a thin dark line, the measurement markers.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.base import ClosedForm
from lavendersim.measures.specs.expectation import Reduction
from lavendersim.measures.specs.selection import Selection
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import AxisName, BodyName, MeasureName, PlaneName
from lavendersim.quantities.quantity import Quantity

Scale = Literal["linear", "log"]
Number = Annotated[float, Quantity()]
Column = Literal[
    "penetration",
    "normal_force",
    "clearance",
    "energy",
    "residual",
    "signorini",
    "cone",
    "dissipation",
    "drift",
    "overlap",
]


class Ideal(ConfigModel):
    """A closed form drawn as a thin dark line through the cells of the panel."""

    closed_form: ClosedForm = Field(description="the formula, evaluated in every cell shown")
    label: str = Field(min_length=1, description="its entry in the legend")


class Level(ConfigModel):
    """A constant drawn as a thin dashed line."""

    value: Number = Field(description="where, in the unit of the y axis")
    label: str = Field(min_length=1, description="its entry in the legend")


class Onset(ConfigModel):
    """A vertical mark where the measure, several cells reduced to one, rises through a level."""

    level: Number = Field(description="the level, in the unit of the y axis")
    reduce: Reduction = Field(default="mean", description="how several cells become one number")
    label: str = Field(min_length=1, description="text beside the mark")


class _Panel(ConfigModel):
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


class MeasureAgainstAxis(_Panel):
    """A measure against a swept axis: markers at the mean, a band from min to max of the rest."""

    kind: Literal["measure_against_axis"]
    measure: MeasureName = Field(description="the measure on the y axis")
    axis: AxisName = Field(description="the swept axis on the x axis")
    ideal: Ideal | None = Field(default=None, description="the closed form it is held against")
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


class RowAgainstIndex(_Panel):
    """A measure that is a row of numbers (sweeps, bounces) against its index."""

    kind: Literal["row_against_index"]
    measure: MeasureName = Field(description="the measure on the y axis")
    first_index: Annotated[int, Quantity(whole=True)] = Field(
        default=0, description="index of the row's first number [-]"
    )
    floor: Number | None = Field(
        default=None, description="numbers below are round-off and drawn at this height"
    )
    factor: Number = Field(default=1.0, description="multiplies the measure for display")


class TimeSeries(_Panel):
    """A logged quantity against time, one line with markers per cell."""

    kind: Literal["time_series"]
    column: Column = Field(
        description="penetration [m], normal_force [N], clearance [m], energy [J], residual [m/s], "
        "drift [m] of any centre from its place at 0.5 s, overlap [m] of any two bodies, from "
        "poses, signorini [m/s], cone [N s], dissipation [J]: the worst contact's violation"
    )
    body: BodyName | None = Field(
        default=None, description="the body, for penetration, normal_force and clearance"
    )
    above: PlaneName | None = Field(default=None, description="the plane, for clearance")
    start: Literal["run", "first_contact"] = Field(
        default="run", description="what time zero means on the x axis"
    )
    window: tuple[Number, Number] | None = Field(
        default=None, description="[from, to] around that zero [s]"
    )
    every: Annotated[int, Quantity(whole=True, minimum=1)] = Field(
        default=1, description="for overlap: every k-th logged step, counted back from the last [-]"
    )
    ideal: Ideal | None = Field(default=None, description="the constant it approaches")
    factor: Number = Field(default=1.0, description="multiplies the values for display")
    x_factor: Number = Field(default=1.0, description="multiplies the time for display (1000: ms)")


class FreeRotation(_Panel):
    """Angular velocity in body axes: Jacobi's solution as lines, the log as markers."""

    kind: Literal["free_rotation"]
    body: BodyName = Field(description="the free body; the only movable one")
    markers: Annotated[int, Quantity(whole=True, minimum=2)] = Field(
        default=60, description="how many logged states are marked, evenly spread [-]"
    )


class MeasureByName(_Panel):
    """A measure for every value of an axis, names or numbers one below the other."""

    kind: Literal["measure_by_name"]
    measure: MeasureName = Field(description="the measure on the x axis; its largest of several")
    axis: AxisName = Field(description="the swept axis whose values stand on the y axis")
    floor: Number | None = Field(
        default=None, description="numbers below are round-off and drawn at this place"
    )
    factor: Number = Field(default=1.0, description="multiplies the measure for display")
    y_scale: Literal["linear"] = Field(default="linear", description="values stand side by side")


class StabilityMap(_Panel):
    """How far one axis can go before a bound breaks, over two others, as colours with numbers."""

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


PanelSpec = Annotated[
    MeasureAgainstAxis | RowAgainstIndex | TimeSeries | FreeRotation | MeasureByName | StabilityMap,
    Field(discriminator="kind"),
]


class FigureSpec(ConfigModel):
    """Panels and the caption beneath them."""

    caption: str = Field(min_length=1, description="what to see, in one or two sentences")
    panels: tuple[PanelSpec, ...] = Field(
        min_length=1, max_length=6, description="left to right; more than three in two rows"
    )
