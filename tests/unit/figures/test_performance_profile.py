"""Performance profiles: the share of problems that a solver solves within a ratio of the best."""

from __future__ import annotations

import numpy as np
from matplotlib import style

from lavendersim.figures import performance_profile
from lavendersim.figures.performance_profile import profile
from lavendersim.figures.style import STYLE


def test_the_profile_counts_problems_within_each_ratio() -> None:
    """Dolan and More's rho: 4 problems, one of them not solved, two as fast as the best."""
    taus, shares = profile([1.0, 3.0, np.inf, 1.0], 30.0)
    assert list(taus) == [1.0, 3.0, 30.0]
    assert list(shares) == [50.0, 75.0, 75.0]
    taus, shares = profile([2.0, 2.0], 30.0)
    assert list(taus) == [1.0, 2.0, 30.0]
    assert list(shares) == [0.0, 100.0, 100.0]
    taus, shares = profile([np.inf, np.inf], 30.0)
    assert list(taus) == [1.0, 30.0]
    assert list(shares) == [0.0, 0.0]


def test_the_profile_reaches_beyond_the_slowest_solver() -> None:
    with style.context(STYLE, after_reset=True):
        figure = performance_profile.compose({"a": [1.0, 400.0], "b": [1.0, np.inf]}, "caption")
    (axes,) = figure.axes
    assert axes.get_xlim()[0] == 1.0
    assert axes.get_xlim()[1] > 400.0
    assert axes.get_xscale() == "log"
    ends = [line.get_ydata()[-1] for line in axes.lines]
    assert ends == [100.0, 50.0]
