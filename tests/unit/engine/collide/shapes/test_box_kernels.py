"""A box's support is a corner; along n look a face, an edge that is flat enough, or nothing."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted
from shape_laws import Seen, check_half_extents, check_support, drawn, unit
from single_bodies import body, row, scratch_of, solid

from lavendersim.engine.collide.records import FACE_LOOP, LINE, POINT
from lavendersim.engine.collide.shapes import SHAPES
from lavendersim.engine.collide.shapes.box import make_edge, make_face, make_feature
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

HALF = np.array([0.5, 0.4, 0.3])


def test_the_support_is_the_farthest_point_and_the_extents_hold_the_box(rng) -> None:
    check_support(SHAPES["box"], rng)
    check_half_extents(SHAPES["box"], rng)


def test_the_face_is_the_one_whose_normal_is_nearest_to_n(rng) -> None:
    face = interpreted(make_face(Spec()))
    for _ in range(40):
        a, n = drawn(SHAPES["box"], rng), unit(rng)
        number, normal = face(row(a), Vec3(*n), scratch_of([]).hulls)
        local = solid(a).matrix.T @ n
        axis = int(np.argmax(np.abs(local)))
        expected = np.sign(local[axis]) * solid(a).matrix[:, axis]
        np.testing.assert_allclose(normal, expected, atol=1e-15)
        assert number == 2 * axis + (local[axis] > 0.0)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_face_that_looks_along_n_is_its_four_corners_on_its_plane(axis, sign, rng) -> None:
    matrix = convex.random_rotation(rng)
    a = body("box", HALF, matrix=matrix)
    tilt = convex.matrix_of([1.0, *0.1 * unit(rng)])  # 11 degrees of 18
    seen = Seen(make_feature, a, tilt @ matrix[:, axis] * sign)
    assert (seen.feature.kind, seen.feature.corners) == (FACE_LOOP, 4)
    np.testing.assert_allclose(seen.normal, sign * matrix[:, axis], atol=1e-15)
    np.testing.assert_allclose(np.abs(seen.corners), np.tile(HALF, (4, 1)), atol=1e-15)
    np.testing.assert_allclose(seen.corners[:, axis], sign * HALF[axis], atol=1e-15)
    assert seen.turns_left()
    assert abs((seen.world[0] - seen.on_plane) @ seen.normal) < 1e-15


def test_an_edge_lies_across_n_and_is_the_highest_and_a_corner_is_nothing(rng) -> None:
    """45 degrees between two faces, and the diagonal of the cube: slopes 0 and 1/sqrt(3)."""
    for _ in range(10):
        matrix = convex.random_rotation(rng)
        a = body("box", HALF, matrix=matrix)
        n = matrix @ [0.0, np.sqrt(0.5), -np.sqrt(0.5)]
        for make in (make_feature, make_edge):
            seen = Seen(make, a, n)
            assert (seen.feature.kind, seen.feature.corners) == (LINE, 2)
            np.testing.assert_allclose(seen.corners[:, 1:], [[0.4, -0.3]] * 2, atol=1e-15)
            np.testing.assert_allclose(np.sort(seen.corners[:, 0]), [-0.5, 0.5], atol=1e-15)
            assert (seen.world @ n).min() == pytest.approx(solids.reach(solid(a), n), abs=1e-15)
        diagonal = matrix @ (np.array([1.0, -1.0, 1.0]) / np.sqrt(3.0))
        assert Seen(make_feature, a, diagonal).feature.kind == POINT


def test_an_edge_is_found_even_where_a_face_looks_along_n() -> None:
    n = np.array([0.0, np.sin(0.1), np.cos(0.1)])
    seen = Seen(make_edge, body("box", HALF), n)
    assert seen.feature.kind == LINE
    np.testing.assert_allclose(seen.corners[:, 1:], [[0.4, 0.3]] * 2, atol=1e-15)
