"""Quantities over time: those of the log, in a window around the zero that is asked for."""

from __future__ import annotations

import numpy as np
from made_impacts import TIME, cells, experiment, legend_of
from swept_pages import LABELS, page
from synthetic import SyntheticCell, ball_and_floor, trace_of

from lavendersim.errors import NOT_REPORTED
from lavendersim.figures.config_figure import compose
from lavendersim.trace.absent import table_without


def test_a_coordinate_over_time_is_that_of_its_body() -> None:
    one = SyntheticCell({"v": 1}, trace_of([0.0, 0.1, 0.3, 0.6], resolved=ball_and_floor()))
    panel = LABELS | {"kind": "time_series", "column": "position_z", "body": "ball"}
    (line,) = page(panel, [one]).axes[0].lines
    column = list(one.trace().bodies).index("ball")
    np.testing.assert_array_equal(line.get_ydata(), one.trace().pose[:, column, 2])
    assert len(set(line.get_ydata())) == 4


def test_a_force_is_a_step_that_ends_at_its_time() -> None:
    (axes,) = compose(experiment(TIME), cells()[:1]).axes
    line = axes.lines[0]
    assert line.get_drawstyle() == "steps-pre"
    np.testing.assert_allclose(line.get_xdata(), [-0.01, 0.0, 0.01], atol=1e-12)
    np.testing.assert_allclose(line.get_ydata(), [0.0, 0.33, 0.0])  # 3.3 N s in 10 ms, in kN
    assert "m g" in legend_of(axes)


def test_drift_is_drawn_from_half_a_second_on() -> None:
    panel = LABELS | {"kind": "time_series", "column": "drift", "factor": 1000.0}
    heights = [0.3] * 50 + [0.01 * k for k in range(11)]
    (axes,) = compose(experiment(panel), [SyntheticCell({}, trace_of(heights))]).axes
    line = axes.lines[0]
    np.testing.assert_allclose(line.get_xdata(), 0.5 + 0.01 * np.arange(11), atol=1e-12)
    np.testing.assert_allclose(line.get_ydata(), 10.0 * np.arange(11), atol=1e-12)


def test_overlap_is_drawn_for_every_k_th_step_back_from_the_last() -> None:
    panel = LABELS | {"kind": "time_series", "column": "overlap", "every": 2}
    log = trace_of([-0.001, -0.002, 0.1, -0.004])
    (axes,) = compose(experiment(panel), [SyntheticCell({}, log)]).axes
    line = axes.lines[0]
    np.testing.assert_allclose(line.get_xdata(), [0.01, 0.03], atol=1e-12)
    np.testing.assert_allclose(line.get_ydata(), [0.002, 0.004], atol=1e-15)


def test_an_engine_that_does_not_tell_a_quantity_has_no_line_and_says_so() -> None:
    silent = trace_of([0.0] * 3, resolved=ball_and_floor())
    names = [name for name in silent.step.dtype.names or () if name != "residual"]
    silent.step = table_without(silent.step[names], {"residual": f"Engine {NOT_REPORTED}"})
    whole = trace_of([0.0] * 3, resolved=ball_and_floor())
    cells = [SyntheticCell({"engine": "one"}, silent), SyntheticCell({"engine": "two"}, whole)]
    panel = LABELS | {"kind": "time_series", "column": "residual", "series": "engine"}
    (axes,) = page(panel | {"series_label": "by {}"}, cells).axes
    assert [len(line.get_xdata()) for line in axes.lines] == [0, 3]
    assert legend_of(axes) == ["by one: not reported", "by two"]
