"""How many values of a measure lie where: outlines of bars, of each series over the same bins."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from lavendersim.figures.registration import draws
from lavendersim.figures.series import looks_of, series_of
from lavendersim.figures.specs.histogram import Histogram
from lavendersim.measures.interfaces import Cell, Floats
from lavendersim.measures.values import Values

LEAST_BINS: Final = 5
MOST_BINS: Final = 100  # where a config does not say how many
ALIKE: Final = 1e-9  # values that differ by less, relatively, differ by round-off
STYLES: Final = ("-", "--", "-.", ":")  # of outlines, so that grey prints tell them apart


@draws(Histogram)
def draw_panel(
    axes: Any, panel: Histogram, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    all_series = series_of(cells, panel.series, panel.series_label)
    rows = [
        panel.factor * np.concatenate([values.row(panel.measure, cell) for cell in one.cells])
        for one in all_series
    ]
    shown = [row[_has_place(row, panel)] for row in rows]
    edges = edges_of(panel, np.concatenate([*shown, np.empty(0)]))
    for index, (one, row, kept, look) in enumerate(
        zip(all_series, rows, shown, looks_of(all_series), strict=True)
    ):
        counts = np.histogram(kept, edges)[0].astype(float)
        if panel.count == "share":
            counts /= max(len(row), 1)
        lost = len(row) - len(kept)
        label = one.label if panel.series is not None else ""
        label += f"{' ' if label else ''}({lost} of {len(row)} without a place)" if lost else ""
        axes.stairs(
            counts,
            edges,
            color=look.colour,
            fill=len(all_series) == 1,
            alpha=0.8 if len(all_series) == 1 else 1.0,
            linewidth=1.8,
            linestyle=STYLES[index % len(STYLES)],
            label=(label if look.named else None) or None,
        )
    axes.set_ylim(bottom=0.0)


def edges_of(panel: Histogram, values: Floats) -> Floats:
    """Return the edges of the bins, ascending; equal values lie in the middle of one bin.

    Their number is the panel's, or the square root of that of the values, between 5 and 100.
    """
    bins = panel.bins or min(max(math.isqrt(max(len(values) - 1, 0)) + 1, LEAST_BINS), MOST_BINS)
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    if panel.x_limits is not None:
        low, high = panel.x_limits
    logarithmic = panel.x_scale == "log"
    if high - low <= ALIKE * max(abs(low), abs(high)):  # all are alike: no width is theirs
        size = max(abs(low), abs(high)) or 1.0
        low, high = (
            (0.9 * low, 1.1 * high) if logarithmic else (low - 0.1 * size, high + 0.1 * size)
        )
    spaced: Floats = (np.geomspace if logarithmic else np.linspace)(low, high, bins + 1)
    return spaced


def _has_place(values: Floats, panel: Histogram) -> Any:
    """Return which values are numbers within the limits of the x axis."""
    places = np.isfinite(values)
    if panel.x_scale == "log":
        places &= values > 0.0
    if panel.x_limits is not None:
        places &= (values >= panel.x_limits[0]) & (values <= panel.x_limits[1])
    return places
