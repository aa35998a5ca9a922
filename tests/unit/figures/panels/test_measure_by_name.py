"""A measure by name: the largest of each, in the order of the sweep, from the top."""

from __future__ import annotations

import numpy as np
from swept_pages import LABELS, cell, page

NAMES = LABELS | {"kind": "measure_by_name", "measure": "impulse", "axis": "solver"}


def test_a_measure_by_name_shows_the_largest_of_each_name() -> None:
    cells = [
        cell({"solver": name, "phase": phase}, impulse)
        for name, impulses in (("one_way", (0.1, 0.3)), ("other", (0.2, 0.05)))
        for phase, impulse in enumerate(impulses)
    ]
    axes = page(NAMES | {"x_scale": "log"}, cells).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["one way", "other"]
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), [0.3, 0.2])


def test_series_of_one_name_stand_beside_each_other_and_round_off_at_the_floor() -> None:
    cells = [
        cell({"solver": name, "e": e}, impulse)
        for (name, e), impulse in {("a", 0): 2.0, ("a", 1): 1e-9, ("b", 0): 3.0}.items()
    ]
    axes = page(
        NAMES | {"series": "e", "series_label": "e = {}", "floor": 0.5, "factor": 10.0}, cells
    ).axes[0]
    first, second = (line for line in axes.lines if line.get_marker() not in ("", "None"))
    np.testing.assert_array_equal(first.get_xdata(), [20.0, 30.0])
    np.testing.assert_array_equal(second.get_xdata(), [5.0])
    above, below = first.get_ydata()[0], second.get_ydata()[0]
    assert above < 0.0 < below == -above  # around the row of their name
    low, high = axes.get_ylim()
    assert low > high  # the first name on top
