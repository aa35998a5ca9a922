"""A measure for each value of an axis, one below the other: markers on thin lines from the left."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lavendersim.figures.registration import draws
from lavendersim.figures.series import by_value, series_of
from lavendersim.figures.specs.measure_by_name import MeasureByName
from lavendersim.figures.style import GREY, look
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.values import Values

APART = 0.22  # rows between the series of one value


@draws(MeasureByName)
def draw_panel(
    axes: Any, panel: MeasureByName, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    shown = [cell for cell in cells if panel.axis in cell.coordinates]
    names = list(by_value(shown, panel.axis))
    all_series = series_of(shown, panel.series, panel.series_label)
    middle = 0.5 * (len(all_series) - 1)
    for index, series in enumerate(all_series):
        split = by_value(series.cells, panel.axis)
        rows = [names.index(name) + APART * (index - middle) for name in split]
        numbers = [
            panel.factor * max(_largest(panel, values, cell) for cell in members)
            for members in split.values()
        ]
        axes.plot(
            numbers,
            rows,
            linestyle="none",
            color=look(index).colour,
            marker=look(index).marker,
            markersize=8.0,
            markeredgecolor="white",
            markeredgewidth=0.6,
            label=series.label if panel.series is not None else None,
            zorder=3,
        )
    for row in range(len(names)):
        axes.axhline(row, color=GREY, linewidth=0.5, zorder=1)
    axes.grid(visible=False, axis="y")
    axes.set_yticks(range(len(names)), [name.replace("_", " ") for name in names])
    axes.set_ylim(len(names) - 0.5, -0.5)  # the first value on top


def _largest(panel: MeasureByName, values: Values, cell: Cell) -> float:
    """Return the largest number of a cell, or the floor for round-off; a NaN stays."""
    largest = float(np.max(values.row(panel.measure, cell)))
    return largest if panel.floor is None else float(np.maximum(largest, panel.floor))
