"""A sphere by its closed forms: V = 4/3 pi r^3, J = 2/5 r^2, h(n) = r."""

from __future__ import annotations

import math

import pytest

from lavendersim.cell.shapes import Sphere

BALL = Sphere(kind="sphere", radius=0.25)


def test_corners_lie_on_the_surface() -> None:
    distances = [math.hypot(*corner) for corner in BALL.corners()]
    assert distances == pytest.approx([0.25] * len(distances), rel=1e-15)


def test_mass_is_that_of_a_ball() -> None:
    volume, moments = BALL.homogeneous()
    assert volume == pytest.approx(math.pi / 48.0, rel=1e-15)  # 4/3 pi / 64
    assert moments == pytest.approx((0.025,) * 3, rel=1e-15)  # 2/5 of 1/16


def test_it_touches_in_one_point_and_kernels_read_its_radius() -> None:
    assert BALL.MOST_POINTS == 1
    assert BALL.row() == {"hx": 0.25}
