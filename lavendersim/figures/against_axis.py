"""A measure against a swept axis: ideal as a line, means as markers, the range as a band."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from lavendersim.experiment.figure_specs import MeasureAgainstAxis
from lavendersim.figures.drawing import draw_band, draw_ideal, ticks_at_values
from lavendersim.figures.ideal import ideal_line
from lavendersim.figures.series import band_along, series_of, swept_path
from lavendersim.figures.style import DARK, look
from lavendersim.measures.sweep_judgements import along_axis, first_rise
from lavendersim.measures.values import Values
from lavendersim.measures.views import Cell


def draw_panel(
    axes: Any, panel: MeasureAgainstAxis, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    shown = [cell for cell in cells if panel.axis in cell.coordinates]
    drawn: set[tuple[float, ...]] = set()
    for index, series in enumerate(series_of(shown, panel.series, panel.series_label)):
        band = band_along(
            series.cells, panel.axis, lambda cell: float(values.row(panel.measure, cell)[0])
        )
        band = band._replace(
            places=band.places * panel.x_factor,
            mean=band.mean * panel.factor,
            low=band.low * panel.factor,
            high=band.high * panel.factor,
        )
        if panel.ideal is not None:
            path = swept_path(experiment, panel.axis)
            form = panel.ideal.closed_form
            places, ideal = ideal_line(form, series.cells, panel.axis, path, panel.x_scale == "log")
            key = tuple(ideal.round(12))
            if key not in drawn:  # series with the same ideal share one line
                label = panel.ideal.label if not drawn else None
                draw_ideal(axes, places * panel.x_factor, ideal * panel.factor, label)
                drawn.add(key)
        draw_band(axes, band, look(index), series.label, size=7.5 - 0.7 * index)
        ticks_at_values(axes, band.places)
    for index, onset in enumerate(panel.onsets):
        stations = along_axis(shown, values.of(panel.measure), panel.axis, onset.reduce)
        place = first_rise(*stations, onset.level / panel.factor) * panel.x_factor
        axes.axvline(
            place,
            color=DARK,
            linewidth=1.1,
            linestyle=((0, (1, 1.5)), (0, (6, 2)))[index % 2],
            label=f"{onset.label}: {place:.2f}",
        )
