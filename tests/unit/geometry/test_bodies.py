"""A configured body as arrays: what moves, its mass and inertia in world axes, its lowest point."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.geometry.bodies import (
    extent_along,
    inverse_inertia,
    inverse_mass,
    is_movable,
    lowest_point,
    mass_of,
    principal_inertia,
    rotation_of,
)
from tests.made_cells import made_body

UP = np.array([0.0, 0.0, 1.0])
BOX = {"kind": "box", "size": [2.0, 4.0, 6.0]}
PLANE = {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}
HALF = math.sqrt(0.5)
QUARTER_ABOUT_X = [HALF, HALF, 0.0, 0.0]


def test_a_fixed_body_and_a_plane_have_no_mass_and_no_inertia() -> None:
    for body in (made_body(BOX, fixed=True), made_body(PLANE)):
        assert not is_movable(body)
        assert mass_of(body) == inverse_mass(body) == 0.0
        assert not principal_inertia(body).any()
        assert not inverse_inertia(body).any()


def test_inverse_inertia_turns_with_the_body() -> None:
    body = made_body(BOX, inertia=[1.0, 2.0, 4.0], orientation=QUARTER_ABOUT_X)
    # A quarter turn about x exchanges y and z.
    assert inverse_inertia(body) == pytest.approx(np.diag([1.0, 0.25, 0.5]), abs=1e-15)
    turn = rotation_of(body)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-15)
    assert turn @ [0.0, 1.0, 0.0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-15)


def test_inverse_mass_is_one_over_mass() -> None:
    assert inverse_mass(made_body(BOX, mass=4.0)) == 0.25


def test_lowest_point_of_a_lying_box_is_the_middle_of_its_side() -> None:
    body = made_body(BOX, position=[1.0, 1.0, 10.0], orientation=QUARTER_ABOUT_X)
    # y stands up: half of 4 m below the centre, also where round-off tilts the side by 1e-16.
    assert lowest_point(body, UP) == pytest.approx([1.0, 1.0, 8.0], abs=1e-14)
    assert extent_along(body, UP) == pytest.approx(2.0, abs=1e-15)


def test_lowest_point_lies_at_the_extent_below_the_centre() -> None:
    body = made_body(BOX, orientation=[0.8, 0.36, 0.48, 0.0])
    assert lowest_point(body, UP) @ UP == pytest.approx(-extent_along(body, -UP), rel=1e-14)
