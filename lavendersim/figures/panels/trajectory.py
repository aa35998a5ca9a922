"""One coordinate of centres against another: a line per body and cell, a dot at its start."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from lavendersim.figures.registration import draws
from lavendersim.figures.series import looks_of, series_of, within
from lavendersim.figures.specs.trajectory import Trajectory
from lavendersim.figures.style import look
from lavendersim.measures.columns import body_columns
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.values import Values

COORDINATES: Final = "xyz"
MOST_NAMED: Final = 8  # bodies with an entry of the legend each


@draws(Trajectory)
def draw_panel(
    axes: Any, panel: Trajectory, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes: a colour per series, or, without series, per body."""
    all_series = series_of(cells, panel.series, panel.series_label)
    looks = looks_of(all_series)
    for index, series in enumerate(all_series):
        for number, cell in enumerate(series.cells):
            trace = cell.trace()
            shown = within(panel.window, np.asarray(trace.step["time"]))
            columns = body_columns(trace, panel.bodies)
            for place, column in enumerate(columns):
                x, y = (trace.pose[shown, column, COORDINATES.index(c)] for c in (panel.x, panel.y))
                label = series.label if number == place == 0 and looks[index].named else None
                if panel.series is None:
                    one = look(place)
                    named = number == 0 and 1 < len(columns) <= MOST_NAMED
                    label = trace.bodies[column].replace("_", " ") if named else None
                else:
                    one = looks[index]
                axes.plot(x, y, color=one.colour, linewidth=1.2, label=label, zorder=3)
                axes.plot(x[:1], y[:1], color=one.colour, marker="o", markersize=5.0, zorder=4)
    if panel.equal:
        axes.set_aspect("equal", adjustable="datalim")
