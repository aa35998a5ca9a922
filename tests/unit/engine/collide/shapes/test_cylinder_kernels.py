"""A cylinder looks along n with a cap, its side, or nothing; its octagon begins at the lowest."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted
from shape_laws import Seen, check_half_extents, check_support, drawn, unit
from single_bodies import body, row, scratch_of, solid

from lavendersim.engine.collide.records import DISC, LINE, POINT
from lavendersim.engine.collide.shapes import SHAPES
from lavendersim.engine.collide.shapes.cylinder import make_face, make_feature, make_support
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

R, HALF = 0.3, 0.5


def turned(rng) -> np.ndarray:
    return body("cylinder", (R, 0.0, HALF), matrix=convex.random_rotation(rng))


def test_the_support_is_the_farthest_point_and_the_extents_hold_the_cylinder(rng) -> None:
    check_support(SHAPES["cylinder"], rng)
    check_half_extents(SHAPES["cylinder"], rng)


def test_straight_along_the_axis_the_support_is_the_caps_centre() -> None:
    support, a = interpreted(make_support(Spec())), body("cylinder", (R, 0.0, HALF))
    for side in (-1.0, 1.0):
        found = support(row(a), Vec3(0.0, 0.0, 2.0 * side), scratch_of([]).hulls)
        assert tuple(found) == (0.0, 0.0, side * HALF)


def test_the_face_is_the_cap_on_the_side_of_n(rng) -> None:
    face = interpreted(make_face(Spec()))
    for _ in range(20):
        a, n = drawn(SHAPES["cylinder"], rng), unit(rng)
        number, normal = face(row(a), Vec3(*n), scratch_of([]).hulls)
        axis = solid(a).matrix[:, 2]
        assert number == (axis @ n > 0.0)
        np.testing.assert_allclose(normal, np.sign(axis @ n) * axis, atol=1e-15)


@pytest.mark.parametrize("up", [-1.0, 1.0])
def test_a_cap_is_an_octagon_on_its_rim_that_begins_at_its_farthest_point(up: float, rng) -> None:
    for _ in range(10):
        a = turned(rng)
        n = convex.matrix_of([1.0, *0.1 * unit(rng)]) @ (up * solid(a).matrix[:, 2])
        seen = Seen(make_feature, a, n)
        assert seen.feature == (DISC, 8, int(up > 0.0))
        np.testing.assert_allclose(np.hypot(*seen.corners[:, :2].T), R, atol=1e-15)
        np.testing.assert_allclose(seen.corners[:, 2], up * HALF, atol=1e-15)
        sides = np.linalg.norm(np.roll(seen.corners, -1, axis=0) - seen.corners, axis=1)
        np.testing.assert_allclose(sides, 2.0 * R * np.sin(np.pi / 8), atol=1e-15)
        assert seen.turns_left()
        assert seen.world[0] @ n == pytest.approx(solids.reach(solid(a), n), abs=1e-15)
        np.testing.assert_allclose(seen.normal, up * solid(a).matrix[:, 2], atol=1e-15)
        np.testing.assert_allclose(seen.on_plane, up * HALF * solid(a).matrix[:, 2], atol=1e-15)
        assert seen.radius == R


def test_a_level_cap_begins_along_gravity_and_without_any_along_x(rng) -> None:
    a = turned(rng)
    matrix = solid(a).matrix
    pull = 9.81 * (0.6 * matrix[:, 0] - 0.8 * matrix[:, 1] + 2.0 * matrix[:, 2])
    seen = Seen(make_feature, a, matrix[:, 2], pull=pull)
    np.testing.assert_allclose(seen.corners[0], (0.6 * R, -0.8 * R, HALF), atol=1e-14)
    for straight in ((0.0, 0.0, 0.0), 9.81 * matrix[:, 2]):
        seen = Seen(make_feature, a, matrix[:, 2], pull=straight)
        np.testing.assert_allclose(seen.corners[0], (R, 0.0, HALF), atol=1e-9)


def test_the_side_is_the_line_that_is_highest_along_n_and_between_is_nothing(rng) -> None:
    for slope, kind in ((0.0, LINE), (0.29, LINE), (-0.29, LINE), (0.31, POINT), (0.94, POINT)):
        a = turned(rng)
        matrix, angle = solid(a).matrix, rng.uniform(0.0, 6.0)
        radial = np.array([np.cos(angle), np.sin(angle), 0.0])
        n = matrix @ (np.sqrt(1.0 - slope * slope) * radial + [0.0, 0.0, slope])
        seen = Seen(make_feature, a, n)
        assert seen.feature.kind == kind
        if kind == LINE:
            expected = R * radial + np.array([[0, 0, -HALF], [0, 0, HALF]])
            np.testing.assert_allclose(seen.corners, expected, atol=1e-14)
