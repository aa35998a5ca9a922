"""A cone looks along n with its base, a line of its side, or nothing."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from interpreted import interpreted
from shape_laws import Seen, check_half_extents, check_support, unit
from single_bodies import body, row, scratch_of, solid

from lavendersim.engine.collide.records import DISC, LINE, POINT
from lavendersim.engine.collide.shapes import SHAPES
from lavendersim.engine.collide.shapes.cone import make_face, make_feature, make_support
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

# Its height is 4 BASE, and its side's normals have n_z = R / sqrt(R^2 + 16 BASE^2) = 0.6.
R, BASE, LEAN = 0.3, 0.1, 0.6


def turned(rng) -> np.ndarray:
    return body("cone", (R, 0.0, BASE), matrix=convex.random_rotation(rng))


def test_the_support_is_the_farthest_point_and_the_extents_hold_the_cone(rng) -> None:
    check_support(SHAPES["cone"], rng)
    check_half_extents(SHAPES["cone"], rng)


def test_straight_along_the_axis_the_support_is_the_apex_or_the_bases_centre() -> None:
    support, a = interpreted(make_support(Spec())), body("cone", (R, 0.0, BASE))
    for z, expected in ((2.0, 3.0 * BASE), (-2.0, -BASE)):
        found = support(row(a), Vec3(0.0, 0.0, z), scratch_of([]).hulls)
        assert tuple(found) == (0.0, 0.0, expected)


def test_the_face_is_the_base(rng) -> None:
    face, a = interpreted(make_face(Spec())), turned(rng)
    number, normal = face(row(a), Vec3(*unit(rng)), scratch_of([]).hulls)
    assert number == 0
    np.testing.assert_allclose(normal, -solid(a).matrix[:, 2], atol=1e-15)


def test_the_base_is_an_octagon_on_its_rim_that_begins_at_its_farthest_point(rng) -> None:
    for _ in range(10):
        a = turned(rng)
        down = -solid(a).matrix[:, 2]
        n = convex.matrix_of([1.0, *0.1 * unit(rng)]) @ down
        seen = Seen(make_feature, a, n)
        assert seen.feature == (DISC, 8, 0)
        np.testing.assert_allclose(np.hypot(*seen.corners[:, :2].T), R, atol=1e-15)
        np.testing.assert_allclose(seen.corners[:, 2], -BASE, atol=1e-15)
        assert seen.turns_left()
        farthest = BASE * (n @ down) + R * np.linalg.norm(np.cross(n, down))
        assert seen.world[0] @ n == pytest.approx(farthest, abs=1e-15)
        np.testing.assert_allclose(seen.normal, down, atol=1e-15)
        assert seen.radius == R


def test_the_side_is_the_line_that_n_is_across_and_between_is_nothing(rng) -> None:
    for slope, kind in ((0.0, LINE), (0.29, LINE), (-0.29, LINE), (0.31, POINT), (-0.31, POINT)):
        a = turned(rng)
        angle, lean = rng.uniform(0.0, 6.0), np.arcsin(LEAN) + np.arcsin(slope)
        radial = np.array([np.cos(angle), np.sin(angle), 0.0])
        n = solid(a).matrix @ (np.cos(lean) * radial + [0.0, 0.0, np.sin(lean)])
        seen = Seen(make_feature, a, n)
        assert seen.feature.kind == kind
        if kind == LINE:
            expected = [[*R * radial[:2], -BASE], [0.0, 0.0, 3.0 * BASE]]
            np.testing.assert_allclose(seen.corners, expected, atol=1e-14)
