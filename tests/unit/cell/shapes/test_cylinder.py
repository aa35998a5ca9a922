"""A cylinder by its closed forms: V = pi r^2 l, J_z = r^2/2, J_x = r^2/4 + l^2/12."""

from __future__ import annotations

import math

import pytest

from lavendersim.cell.shapes import Cylinder

CYLINDER = Cylinder(kind="cylinder", radius=0.3, length=0.8)


def test_bounding_sphere_passes_through_the_rims() -> None:
    assert CYLINDER.bounding_radius() == pytest.approx(0.5, rel=1e-15)  # 0.3, 0.4
    # Along (3, 4)/5 in the plane of the axis: the rim itself, which is as far as the sphere.
    assert CYLINDER.extent((0.6, 0.0, 0.8)) == pytest.approx(0.5, rel=1e-15)


def test_mass_is_that_of_a_round_bar() -> None:
    volume, moments = CYLINDER.homogeneous()
    assert volume == pytest.approx(math.pi * 0.072, rel=1e-15)
    across = 0.0225 + 0.64 / 12.0
    assert moments == pytest.approx((across, across, 0.045), rel=1e-15)


def test_middle_of_a_cap_or_of_the_side_is_farthest_where_it_lies_flat() -> None:
    assert CYLINDER.farthest_point((0.0, 0.0, -1.0)) == (0.0, 0.0, -0.4)
    assert CYLINDER.farthest_point((0.0, 1.0, 0.0)) == (0.0, 0.3, 0.0)


def test_nearly_upright_it_reaches_a_rim_to_first_order() -> None:
    # h = l/2 cos t + r sin t; at t = 1e-9 cos t is 1 in all digits and 1 - n_z^2 would be 0.
    reach = CYLINDER.extent((1e-9, 0.0, math.cos(1e-9)))
    assert reach == pytest.approx(0.4, abs=3e-10 + 1e-15)


def test_the_thinner_of_length_and_diameter_is_its_thickness() -> None:
    assert CYLINDER.thickness() == 0.6
    assert Cylinder(kind="cylinder", radius=0.3, length=0.1).thickness() == 0.1
