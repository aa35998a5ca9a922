"""A measure against a swept axis: ideal as a line, means as markers, the range as a band."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from lavendersim.figures.drawing import draw_band, draw_ideal, ticks_at_values
from lavendersim.figures.ideal import ideal_line
from lavendersim.figures.registration import draws
from lavendersim.figures.series import Band, band_along, looks_of, series_of, swept_path
from lavendersim.figures.specs.measure_against_axis import MeasureAgainstAxis
from lavendersim.figures.style import DARK, GREY
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.sweep_judgements import along_axis, first_rise
from lavendersim.measures.values import Values

# Of lines drawn for comparison.
DASHES: Final = ((0, (1, 1.5)), (0, (6, 2)), (0, (5, 2, 1, 2)))


def marker_size(index: int, count: int) -> float:
    """Return the size [pt] of the markers of one of `count` series.

    Small ones lie on large ones: of markers in one place all are seen.
    """
    return max(4.0, 10.0 - 2.4 * index) if count > 1 else 7.5


def _lifted(panel: MeasureAgainstAxis, number: float) -> float:
    """Return a number, or the floor for one that is round-off; NaN stays."""
    return float(number) if panel.floor is None else float(np.maximum(number, panel.floor))


def _draw_orders(axes: Any, orders: Sequence[float], band: Band) -> None:
    """Draw lines of given slopes through the mean at the greatest place."""
    if not len(band.places):
        return
    for index, order in enumerate(orders):
        axes.plot(
            band.places,
            band.mean[-1] * (band.places / band.places[-1]) ** order,
            color=GREY,
            linewidth=1.1,
            linestyle=DASHES[index % 3],
            label=f"order {order:g}",
            zorder=1,
        )


def _draw_proportions(axes: Any, factors: Sequence[float], places: np.ndarray) -> None:
    """Draw lines y = k x over the places."""
    ends = np.array([places.min(), places.max()])
    for index, factor in enumerate(factors):
        label = "y = x" if factor == 1.0 else f"y = {factor:g} x"
        axes.plot(
            ends,
            factor * ends,
            color=GREY,
            linewidth=1.1,
            label=label,
            zorder=1,
            linestyle=DASHES[index % 3],
        )


@draws(MeasureAgainstAxis)
def draw_panel(
    axes: Any, panel: MeasureAgainstAxis, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    shown = [cell for cell in cells if panel.axis in cell.coordinates]
    drawn: set[tuple[float, ...]] = set()
    places_of_all: list[float] = []
    all_series = series_of(shown, panel.series, panel.series_label)
    looks = looks_of(all_series)
    for index, series in enumerate(all_series):
        band = band_along(
            series.cells,
            panel.axis,
            lambda cell: _lifted(panel, values.row(panel.measure, cell)[0]),
        )
        band = band._replace(
            places=band.places * panel.x_factor,
            mean=band.mean * panel.factor,
            low=band.low * panel.factor,
            high=band.high * panel.factor,
        )
        if panel.ideal is not None:
            path = swept_path(experiment, panel.axis)
            log_x = panel.x_scale == "log"
            places, ideal = ideal_line(panel.ideal, series.cells, panel.axis, path, log_x)
            key = tuple(ideal.round(12))
            if key not in drawn:  # series with the same ideal share one line
                label = panel.ideal.label if not drawn else None
                draw_ideal(axes, places * panel.x_factor, ideal * panel.factor, label)
                drawn.add(key)
        draw_band(axes, band, looks[index], series.label, size=marker_size(index, len(all_series)))
        places_of_all += list(band.places)
        if index == 0:
            _draw_orders(axes, panel.orders, band)
            if panel.proportions and len(band.places):
                _draw_proportions(axes, panel.proportions, band.places)
    if places_of_all:
        ticks_at_values(axes, places_of_all)
    for index, onset in enumerate(panel.onsets):
        stations = along_axis(shown, values.of(panel.measure), panel.axis, onset.reduce)
        place = first_rise(*stations, onset.level / panel.factor) * panel.x_factor
        axes.axvline(
            place,
            color=DARK,
            linewidth=1.1,
            linestyle=DASHES[index % 2],
            label=f"{onset.label}: {place:.2f}",
        )
