"""A free rotation: Jacobi's solution as lines, what was logged as markers on it."""

from __future__ import annotations

import numpy as np
import pytest
from made_impacts import LABELS as IMPACTS
from made_impacts import experiment, legend_of
from synthetic import SyntheticCell, spinning_log

from lavendersim.figures.config_figure import compose
from lavendersim.figures.style import DARK

TOP = IMPACTS | {"kind": "free_rotation", "body": "top", "markers": 5}


def test_a_free_rotation_has_the_exact_solution_as_lines_and_the_log_as_markers() -> None:
    log = spinning_log()
    (axes,) = compose(experiment(TOP), [SyntheticCell({}, log)]).axes
    assert legend_of(axes) == ["Jacobi", "about x", "about y", "about z"]
    measured = [line for line in axes.lines if line.get_marker() != "None"]
    assert [len(line.get_xdata()) for line in measured] == [5, 5, 5]
    assert measured[1].get_ydata()[0] == pytest.approx(5.0)
    exact = [line for line in axes.lines if line.get_color() == DARK]
    for line, markers in zip(exact, measured, strict=True):
        # 1200 points over 20 s, between which a slope of up to 14 rad/s^2 is a straight line
        curve = np.interp(markers.get_xdata(), line.get_xdata(), line.get_ydata())
        np.testing.assert_allclose(markers.get_ydata(), curve, atol=1e-2)
