"""A row of numbers against its index."""

from __future__ import annotations

import numpy as np
from made_impacts import LABELS as IMPACTS
from made_impacts import ROW, cells, experiment

from lavendersim.figures.config_figure import compose


def test_a_logarithmic_axis_leaves_out_what_is_not_positive() -> None:
    (axes,) = compose(experiment(ROW), cells()).axes
    assert axes.get_yscale() == "log"
    assert np.isnan(axes.lines[0].get_ydata()).tolist() == [False, False, True]


def test_series_end_with_their_shortest_row_and_begin_with_the_first_index() -> None:
    panel = IMPACTS | {
        "kind": "row_against_index",
        "measure": "residual",
        "series": "timestep",
        "series_label": "{}",
        "first_index": 4,
        "factor": 2.0,
        "floor": 0.5,
    }
    (axes,) = compose(experiment(panel), cells()).axes
    lines = [line for line in axes.lines if line.get_marker() not in ("", "None")]
    assert len(lines) == 2
    for line in lines:
        np.testing.assert_array_equal(line.get_xdata(), [4, 5, 6])
        np.testing.assert_allclose(line.get_ydata(), [2.0, 1.0, 1.0])  # 1, 0.1 and 0 at the floor
