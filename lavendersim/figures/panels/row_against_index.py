"""A measure that is a row of numbers (sweeps, bounces) against its index, one series per value."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from lavendersim.figures.drawing import draw_band
from lavendersim.figures.registration import draws
from lavendersim.figures.series import band_of_rows, looks_of, series_of
from lavendersim.figures.specs.row_against_index import RowAgainstIndex
from lavendersim.measures.interfaces import Cell, Floats
from lavendersim.measures.values import Values


@draws(RowAgainstIndex)
def draw_panel(
    axes: Any, panel: RowAgainstIndex, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    all_series = series_of(cells, panel.series, panel.series_label)
    for series, look in zip(all_series, looks_of(all_series), strict=True):
        rows = [_shown(values.row(panel.measure, cell), panel) for cell in series.cells]
        band = band_of_rows(rows, panel.first_index, panel.factor)
        draw_band(axes, band, look, series.label, joined=True)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 2, 5, 10]))


def _shown(row: Floats, panel: RowAgainstIndex) -> Floats:
    """Lift round-off to the floor; a logarithmic axis leaves out what is not positive."""
    if panel.floor is not None:
        row = np.maximum(row, panel.floor)
    if panel.y_scale == "log":
        row = np.where(row > 0.0, row, np.nan)
    return row
