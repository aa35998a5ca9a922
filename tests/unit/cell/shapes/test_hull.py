"""A hull's extent, bounds and width by its corners."""

from __future__ import annotations

import math

import pytest

from lavendersim.cell.shapes import CellHull

# A regular tetrahedron about its centre.
CORNERS = ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))
HULL = CellHull(
    kind="hull",
    points=CORNERS,
    faces=((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)),
    centre=(0.0, 0.0, 0.0),
    axes=(1.0, 0.0, 0.0, 0.0),
)


def test_corner_is_three_times_as_far_as_the_face_behind_it() -> None:
    third = 1.0 / math.sqrt(3.0)
    corner = HULL.extent((third, third, third))
    assert corner == pytest.approx(math.sqrt(3.0), rel=1e-15)
    assert HULL.bounding_radius() == pytest.approx(corner, rel=1e-15)
    # The circumscribed sphere of a regular tetrahedron has three times the radius of its inscribed.
    assert HULL.extent((-third, -third, -third)) == pytest.approx(corner / 3.0, rel=1e-15)


def test_its_width_is_that_of_the_cube_around_it() -> None:
    assert HULL.thickness() == 2.0


def test_lowest_point_has_no_closed_form() -> None:
    with pytest.raises(ValueError, match="no closed form for the lowest point of a hull"):
        HULL.farthest_point((0.0, 0.0, 1.0))
