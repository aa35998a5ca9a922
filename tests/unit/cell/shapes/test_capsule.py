"""A capsule by its closed forms; without length it is a ball, very long a rod."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.cell.shapes import Capsule, Sphere

CAPSULE = Capsule(kind="capsule", radius=0.1, length=0.6)


def test_reaches_half_its_whole_length_along_its_axis_and_its_radius_across() -> None:
    assert CAPSULE.extent((0.0, 0.0, -1.0)) == pytest.approx(0.4, rel=1e-15)
    assert CAPSULE.extent((0.0, 1.0, 0.0)) == 0.1
    assert CAPSULE.bounding_radius() == pytest.approx(0.4, rel=1e-15)


def test_middle_of_the_side_is_farthest_across() -> None:
    assert CAPSULE.farthest_point((1.0, 0.0, 0.0)) == (0.1, 0.0, 0.0)


def test_volume_is_a_cylinder_and_a_ball() -> None:
    # pi r^2 l + 4/3 pi r^3 = pi (0.006 + 0.004 / 3)
    assert CAPSULE.homogeneous().volume == pytest.approx(math.pi * 0.022 / 3.0, rel=1e-15)


def test_moments_are_those_of_its_slices() -> None:
    """Discs of radius R(z): dJ_z = pi R^4/2 dz, dJ_x = (pi R^4/4 + pi R^2 z^2) dz.

    R^2 is a polynomial of degree 2 on the bar and on each half ball: five points are exact.
    """
    r, half = 0.1, 0.3
    points, weights = np.polynomial.legendre.leggauss(5)
    volume = across = along = 0.0
    for low, high, centre in (
        (-half - r, -half, -half),
        (-half, half, None),
        (half, half + r, half),
    ):
        z = 0.5 * (low + high) + 0.5 * (high - low) * points
        square = np.full(5, r * r) if centre is None else r * r - (z - centre) ** 2
        dz = 0.5 * (high - low) * weights * math.pi
        volume += float(dz @ square)
        across += float(dz @ (square**2 / 4.0 + square * z**2))
        along += float(dz @ square**2) / 2.0
    found = CAPSULE.homogeneous()
    assert found.volume == pytest.approx(volume, rel=1e-14)
    assert found.moments == pytest.approx((across / volume,) * 2 + (along / volume,), rel=1e-14)


def test_short_it_is_a_ball_and_long_a_rod() -> None:
    # The first order in l / r of J is 5/16 and less: with l = 1e-9 r it is below 1e-9.
    short = Capsule(kind="capsule", radius=0.1, length=1e-10).homogeneous()
    ball = Sphere(kind="sphere", radius=0.1).homogeneous()
    assert short.volume == pytest.approx(ball.volume, rel=1e-8)
    assert short.moments == pytest.approx(ball.moments, rel=1e-8)
    # The balls' share of a rod's mass is 4 r / 3 l, and they stand at its ends, three times as
    # heavy there as l^2/12 counts them.
    long = Capsule(kind="capsule", radius=1e-6, length=1.0).homogeneous()
    assert long.moments[0] == pytest.approx(1.0 / 12.0, rel=1e-5)
    assert long.moments[2] == pytest.approx(0.5e-12, rel=1e-5)
