"""A logged quantity against time, one line with markers per cell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lavendersim.errors import NotReportedError
from lavendersim.figures.drawing import draw_ideal
from lavendersim.figures.ideal import ideal_of
from lavendersim.figures.registration import draws
from lavendersim.figures.series import axis_of, looks_of, series_of, within
from lavendersim.figures.specs.time_series import OF_STEPS, POSITIONS, SPEEDS, TimeSeries
from lavendersim.measures.columns import (
    clearance_by_step,
    contacts_of,
    deepest_by_step,
    mechanical_energy,
    step_column,
    summed_by_step,
)
from lavendersim.measures.interfaces import Cell, Floats, Rows, Trace
from lavendersim.measures.kinds.motion import drift_by_step
from lavendersim.measures.overlap_of_bodies import overlap_of_rows
from lavendersim.measures.values import Values

DRIFT_AFTER = 0.5  # [s] as the measure counts it
MOST_MARKERS = 130  # beyond this many points markers run into a stripe; every k-th is marked


@draws(TimeSeries)
def draw_panel(
    axes: Any, panel: TimeSeries, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    all_series = series_of(cells, panel.series or axis_of(cells), panel.series_label)
    looks = looks_of(all_series)
    for index, series in enumerate(all_series):
        for number, cell in enumerate(series.cells):
            label = series.label
            try:
                time, quantity = window_of(panel, cell.trace())
            except NotReportedError:  # the lines of the other engines are drawn
                time, quantity, label = np.empty(0), np.empty(0), f"{label or 'it'}: not reported"
            axes.plot(
                time * panel.x_factor,
                quantity * panel.factor,
                # a force is the average over the step that ends at its time
                drawstyle="steps-pre" if panel.column == "normal_force" else "default",
                color=looks[index].colour,
                linewidth=1.0,
                marker=looks[index].marker,
                markersize=3.5,
                markevery=max(1, len(time) // MOST_MARKERS),
                markeredgecolor="none",
                label=label if number == 0 and looks[index].named else None,
                zorder=3,
            )
            if panel.ideal is not None and index == number == 0 and len(time):
                ideal = ideal_of(panel.ideal, cell)
                ends = np.array([time[0], time[-1]]) * panel.x_factor
                level = [ideal * panel.factor] * 2
                draw_ideal(axes, ends, level, panel.ideal.label, order=4.0)


def window_of(panel: TimeSeries, trace: Trace) -> tuple[Floats, Floats]:
    """Return time [s] and the panel's quantity [SI] in the panel's window."""
    time = trace.step["time"].astype(np.float64)
    quantity = quantity_of(panel, trace)
    if panel.start == "first_contact":
        touching = _contacts(panel, trace)["step"]
        if len(touching):
            time = time - time[np.searchsorted(trace.step["step"], touching[0])]
    known = ~np.isnan(quantity) & within(panel.window, time)
    return time[known], quantity[known]


def quantity_of(panel: TimeSeries, trace: Trace) -> Floats:
    """Return the panel's quantity in every logged step [SI]; NaN where it is not taken."""
    if panel.column in ("drift", "overlap"):
        return _of_poses(panel, trace)
    if panel.column == "energy":
        return mechanical_energy(trace)
    if panel.column in ("residual", "signorini", "cone", "dissipation"):
        logged = step_column(trace, panel.column)
        if logged is None:
            return np.full(len(trace.step), np.nan)  # nothing could touch, or no friction
        return np.asarray(logged, dtype=np.float64)
    if panel.column in OF_STEPS:
        return np.asarray(trace.step[panel.column], dtype=np.float64)
    if panel.column in POSITIONS:
        assert panel.body is not None
        column = list(trace.bodies).index(panel.body)
        coordinates: Floats = trace.pose[:, column, POSITIONS.index(panel.column)]
        return coordinates
    if panel.column in SPEEDS:
        assert panel.body is not None
        column = list(trace.bodies).index(panel.body)
        speeds: Floats = trace.velocity[:, column, SPEEDS.index(panel.column)]
        return speeds
    if panel.column == "clearance":
        assert panel.body is not None
        assert panel.above is not None
        return clearance_by_step(trace, panel.body, panel.above)
    rows = _contacts(panel, trace)
    if panel.column == "penetration":
        return deepest_by_step(trace, rows)
    return summed_by_step(trace, rows, "force_n")


def _of_poses(panel: TimeSeries, trace: Trace) -> Floats:
    quantity = np.full(len(trace.step), np.nan)
    if panel.column == "drift":
        later = drift_by_step(trace, DRIFT_AFTER)
        quantity[len(quantity) - len(later) :] = later
        return quantity
    rows = np.arange(len(quantity))[:: -panel.every]
    quantity[rows] = overlap_of_rows(trace, rows)
    return quantity


def _contacts(panel: TimeSeries, trace: Trace) -> Rows:
    if panel.body is None:
        rows: Rows = trace.contact
        return rows
    return contacts_of(trace, panel.body)
