"""A measure against an axis: markers, bands, ideals, slopes and onsets where they belong."""

from __future__ import annotations

import numpy as np
import pytest
from made_impacts import AGAINST_AXIS, cells, experiment, legend_of
from swept_pages import LABELS, cell, page
from synthetic import SyntheticCell, trace_of

from lavendersim.figures.config_figure import compose
from lavendersim.figures.style import DARK


def luminance(colour: str) -> float:
    red, green, blue = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def test_slopes_for_comparison_go_through_the_last_point() -> None:
    cells = [cell({"step": step}, impulse) for step, impulse in ((1.0, 0.5), (2.0, 0.8))]
    panel = LABELS | {
        "kind": "measure_against_axis",
        "measure": "impulse",
        "axis": "step",
        "orders": (2,),
    }
    lines = {line.get_label(): line for line in page(panel, cells).axes[0].lines}
    np.testing.assert_allclose(lines["order 2"].get_ydata(), [0.2, 0.8], rtol=1e-15)


def test_more_than_five_series_of_numbers_are_lines_from_dark_to_light() -> None:
    values = [4, 1, 6, 2, 5, 3, 7]  # in the order of the sweep, which is no rising one
    cells = [cell({"mass": mass, "v": v}, 0.1 * mass * v) for v in values for mass in (1, 2)]
    panel = LABELS | {
        "kind": "measure_against_axis",
        "measure": "impulse",
        "axis": "mass",
        "series": "v",
        "series_label": "{} m/s",
    }
    axes = page(panel, cells).axes[0]
    assert {line.get_marker() for line in axes.lines} == {""}
    assert {line.get_linestyle() for line in axes.lines} == {"-"}
    by_value = sorted(zip(values, axes.lines, strict=True), key=lambda pair: pair[0])
    shades = [luminance(line.get_color()) for _, line in by_value]
    assert shades == sorted(shades)
    assert len(set(shades)) == len(values)
    assert shades[-1] < 0.75  # still seen on white
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert sorted(legend) == ["1 m/s", "4 m/s", "7 m/s"]  # lowest, middle, highest
    few = page(panel, cells[:10]).axes[0]
    assert "" not in {line.get_marker() for line in few.lines}


def test_measurements_are_markers_and_the_ideal_is_a_thin_dark_line() -> None:
    (axes,) = compose(experiment(AGAINST_AXIS), cells()).axes
    lines = {line.get_label(): line for line in axes.lines}
    coarse, fine = lines["timestep 1/100 s"], lines["timestep 1/200 s"]
    assert coarse.get_linestyle() == fine.get_linestyle() == "None"
    assert coarse.get_marker() != fine.get_marker()
    assert coarse.get_color() != fine.get_color()
    np.testing.assert_allclose(fine.get_xdata(), [-4.0, -2.0, -1.0, 1.0])
    np.testing.assert_allclose(fine.get_ydata(), [12.0, 6.0, 3.0, 0.0])
    ideal = lines["Newton"]
    assert ideal.get_color() == DARK
    assert ideal.get_linewidth() < 1.5
    assert len(ideal.get_xdata()) > 60  # between the swept values too, so the kink at 0 shows
    x, y = ideal.get_xdata(), ideal.get_ydata()
    np.testing.assert_allclose(y, np.maximum(0.0, -3.0 * x), atol=1e-12)


def test_the_spread_over_other_axes_is_a_band_around_the_mean() -> None:
    (axes,) = compose(experiment(AGAINST_AXIS | {"series": None}), cells()).axes
    (band,) = axes.collections
    heights = band.get_paths()[0].vertices[:, 1]
    assert heights.max() == pytest.approx(13.2)
    means = next(line for line in axes.lines if line.get_label() == "measured")
    assert means.get_ydata()[0] == pytest.approx(12.6)


def test_an_onset_is_marked_where_the_mean_rises_through_the_level() -> None:
    rising = AGAINST_AXIS | {"series": None, "axis": "height", "ideal": None}
    made = [SyntheticCell({"height": k}, trace_of([0.0] * 6, [(3, 2.0 * k, 0)])) for k in range(5)]
    (axes,) = compose(experiment(rising), made).axes
    assert "onset: 2.00" in legend_of(axes)


def test_a_number_below_the_floor_is_drawn_at_it() -> None:
    (axes,) = compose(experiment(AGAINST_AXIS | {"ideal": None, "floor": 5.0}), cells()).axes
    fine = next(line for line in axes.lines if line.get_label() == "timestep 1/200 s")
    np.testing.assert_allclose(fine.get_ydata(), [12.0, 6.0, 5.0, 5.0])
