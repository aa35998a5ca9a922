"""Parts of a panel: constants to compare with, markers that lie on each other, ticks."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from lavendersim.figures.drawing import draw_levels, legend, ticks_at_values
from lavendersim.figures.panels.measure_against_axis import marker_size
from lavendersim.figures.specs.measure_against_axis import MeasureAgainstAxis


def with_levels(*levels: dict[str, Any]) -> Any:
    """Axes with nothing on them but a panel's levels and their legend."""
    labels = {"title": "one idea", "x_label": "there [m]", "y_label": "here [m]"}
    panel = labels | {"kind": "measure_against_axis", "measure": "m", "axis": "a", "levels": levels}
    axes = Figure().add_subplot()
    draw_levels(axes, MeasureAgainstAxis.model_validate(panel).levels)
    legend(axes)
    return axes


def test_levels_of_one_label_are_drawn_alike_and_named_once() -> None:
    ends = ({"value": 4.0, "label": "bound"}, {"value": -4.0, "label": "bound"})
    axes = with_levels(*ends, {"value": 1.0, "label": "other"})
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["bound", "other"]
    high, low, other = (line._dash_pattern for line in axes.lines)
    assert high == low != other


def test_markers_in_one_place_are_all_seen() -> None:
    sizes = [marker_size(index, 3) for index in range(3)]
    # half the difference sticks out: 0.6 pt of white edge and 0.6 pt, a pixel at 150 dpi, of colour
    assert all(one - other >= 2.4 - 1e-9 for one, other in pairwise(sizes))


@pytest.mark.parametrize(("value", "text"), [(1000.0, "1000"), (1e4, "10000"), (16.66667, "16.7")])
def test_ticks_at_swept_values_are_short_and_plain(value: float, text: str) -> None:
    axes = Figure().add_subplot()
    axes.set_xscale("log")
    ticks_at_values(axes, np.array([value, 2.0 * value]))
    assert axes.xaxis.get_major_formatter()(value, 0) == text


def test_ticks_whose_labels_would_overlap_are_left_out() -> None:
    axes = Figure().add_subplot()
    axes.set_xscale("log")
    # log(1.04/1)/log(4) is 3 % of the axis, log(2/1.04)/log(4) 47 %.
    ticks_at_values(axes, [0.5, 1.0, 1.04, 2.0])
    assert list(axes.xaxis.get_majorticklocs()) == [0.5, 1.0, 2.0]
