"""A box by its closed forms: V = abc, J_x = (b^2 + c^2)/12, corners at half its edges."""

from __future__ import annotations

import math

import pytest

from lavendersim.cell.shapes import Box

BOX = Box(kind="box", size=(0.2, 0.6, 0.3))


def test_bounding_sphere_passes_through_all_eight_corners() -> None:
    corners = BOX.corners()
    assert len(set(corners)) == 8
    # (0.1, 0.3, 0.15): 0.01 + 0.09 + 0.0225 = 0.35^2
    assert [math.hypot(*corner) for corner in corners] == pytest.approx([0.35] * 8, rel=1e-15)
    assert BOX.bounding_radius() == pytest.approx(0.35, rel=1e-15)


def test_mass_is_that_of_its_edges() -> None:
    volume, moments = BOX.homogeneous()
    assert volume == pytest.approx(0.036, rel=1e-15)
    # (0.36 + 0.09)/12, (0.04 + 0.09)/12, (0.04 + 0.36)/12
    assert moments == pytest.approx((0.0375, 0.13 / 12.0, 0.4 / 12.0), rel=1e-15)


def test_middle_of_a_side_is_farthest_along_its_normal() -> None:
    assert BOX.farthest_point((0.0, -1.0, 0.0)) == (0.0, -0.3, 0.0)
    assert BOX.farthest_point((math.sqrt(0.5), 0.0, -math.sqrt(0.5))) == (0.1, 0.0, -0.15)


def test_kernels_read_half_edges() -> None:
    assert BOX.row() == {"hx": 0.1, "hy": 0.3, "hz": 0.15}
