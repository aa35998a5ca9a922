"""A trajectory: a line of two coordinates from a dot, of every movable body or of those named."""

from __future__ import annotations

import numpy as np
from swept_pages import LABELS, page
from synthetic import SyntheticCell, ball_and_floor, trace_of


def test_a_trajectory_is_a_line_of_two_coordinates_from_a_dot() -> None:
    one = SyntheticCell({"v": 1}, trace_of([0.0, 0.1, 0.3, 0.6], resolved=ball_and_floor()))
    panel = LABELS | {"kind": "trajectory", "bodies": ("ball",), "window": (0.005, 0.03)}
    axes = page(panel, [one]).axes[0]
    way, start = axes.lines
    column = list(one.trace().bodies).index("ball")
    np.testing.assert_array_equal(way.get_xydata(), one.trace().pose[1:, column][:, [0, 2]])
    np.testing.assert_array_equal(start.get_xydata(), way.get_xydata()[:1])


def test_movable_bodies_are_shown_where_none_is_named_and_a_metre_is_a_metre() -> None:
    one = SyntheticCell({"v": 1}, trace_of([0.0, 0.1], resolved=ball_and_floor()))
    axes = page(LABELS | {"kind": "trajectory", "x": "z", "y": "y"}, [one]).axes[0]
    line, _ = axes.lines  # of the ball alone; the floor cannot move
    np.testing.assert_array_equal(line.get_xdata(), one.trace().pose[:, 1, 2])
    assert axes.get_aspect() == 1.0
    loose = page(LABELS | {"kind": "trajectory", "equal": False}, [one]).axes[0]
    assert loose.get_aspect() == "auto"
