"""A sphere and a capsule are as far apart as the centre is from the axis, less both radii."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from single_bodies import body, manifold, solid

R, SPHERE = 0.2, 0.3


def test_the_nearest_point_of_the_axis_says_where_they_touch(rng) -> None:
    """A search along the axis, without derivatives: right to 1e-8 in place."""
    ends = 0
    for _ in range(60):
        half = rng.uniform(0.2, 0.6)
        a = body("capsule", (R, 0.0, half), rng.normal(size=3), convex.random_rotation(rng))
        shape = solid(a)
        place = shape.centre + 0.7 * rng.normal(size=3)
        axis = shape.matrix[:, 2]

        def distance(s, centre=shape.centre, axis=axis, place=place):
            return float(np.linalg.norm(place - centre - s * axis))

        found = minimize_scalar(
            distance, bounds=(-half, half), method="bounded", options={"xatol": 1e-9}
        )
        s = min((found.x, -half, half), key=distance)
        ends += abs(s) == half
        seen = manifold("sphere_capsule", a, body("sphere", (SPHERE, 0, 0), place), 10.0)
        assert seen.phi == pytest.approx([distance(s) - R - SPHERE], abs=1e-12)
        n = (place - shape.centre - s * axis) / distance(s)
        np.testing.assert_allclose(seen.normal, n, atol=1e-6)
        middle = place - (SPHERE + 0.5 * seen.phi[0]) * seen.normal
        np.testing.assert_allclose(seen.points[0], middle, atol=1e-14)
    assert 5 < ends < 55


def test_a_centre_on_the_axis_leaves_along_the_capsules_x(rng) -> None:
    matrix = np.eye(3)[[1, 2, 0]]  # its axis along y, its x along z
    a = body("capsule", (R, 0.0, 0.5), matrix=matrix)
    found = manifold("sphere_capsule", a, body("sphere", (SPHERE, 0, 0), 0.3 * matrix[:, 2]))
    np.testing.assert_array_equal(found.normal, matrix[:, 0])
    assert found.phi == pytest.approx([-R - SPHERE], abs=1e-15)


def test_beyond_the_margin_there_is_none() -> None:
    a = body("capsule", (R, 0.0, 0.5))
    for gap, count in ((0.099, 1), (0.101, 0)):
        place = (0.0, R + SPHERE + gap, 0.4)
        assert (
            len(manifold("sphere_capsule", a, body("sphere", (SPHERE, 0, 0), place), 0.1).phi)
            == count
        )
