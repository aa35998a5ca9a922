"""Circles that a solid is drawn by, and what a convex solid has that declares no more."""

from __future__ import annotations

import math

import pytest

from lavendersim.cell.shapes.shape import ROUND, ball, circle
from tests.made_cells import MadeShape


def test_a_circle_has_its_radius_at_its_height() -> None:
    points = circle(0.5, -2.0)
    assert len(set(points)) == ROUND
    assert {z for _, _, z in points} == {-2.0}
    assert [math.hypot(x, y) for x, y, _ in points] == pytest.approx([0.5] * ROUND, rel=1e-15)


def test_a_ball_looks_round_from_its_axes_and_diagonals() -> None:
    # Around it a great circle has a corner at least every 360/ROUND degrees, so that along a
    # direction in its plane the farthest falls short by 1 - cos(180/ROUND) of the radius.
    points = ball(1.0, 3.0)
    s = math.sqrt(0.5)
    for x, y, z in ((1, 0, 0), (0, 0, -1), (s, s, 0), (-s, 0, s), (0, s, s), (0, -s, s)):
        farthest = max(p[0] * x + p[1] * y + (p[2] - 3.0) * z for p in points)
        assert math.cos(math.pi / ROUND) - 1e-15 <= farthest <= 1.0 + 1e-15


def test_a_convex_solid_need_not_have_a_farthest_point_or_a_row_of_numbers() -> None:
    shape = MadeShape()
    assert shape.row() == {}
    assert shape.MOST_POINTS == 4
    with pytest.raises(ValueError, match="no closed form for the lowest point of a made"):
        shape.farthest_point((1.0, 0.0, 0.0))
