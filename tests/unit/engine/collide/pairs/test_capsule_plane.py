"""A capsule touches a plane under the ends of its axis that are within the margin."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from single_bodies import body, manifold, solid

N, OFFSET, R, HALF = np.array([2.0, -1.0, 2.0]) / 3.0, 0.7, 0.2, 0.5


def test_each_end_is_a_sphere_of_its_own(rng) -> None:
    counts = set()
    for _ in range(60):
        centre = (OFFSET + R + rng.uniform(-0.6, 0.6)) * N + np.cross(N, rng.normal(size=3))
        b = body("capsule", (R, 0.0, HALF), centre, convex.random_rotation(rng))
        found = manifold("capsule_plane", body("plane", N, offset=OFFSET), b, 0.1)
        shape, expected = solid(b), {}
        for end in range(2):
            p = shape.centre + (2 * end - 1) * HALF * shape.matrix[:, 2]
            phi = p @ N - OFFSET - R
            if phi <= 0.1:
                expected[end] = (phi, p - (R + 0.5 * phi) * N)
        counts.add(len(expected))
        assert found.feature.tolist() == list(expected)
        for phi, point, end in zip(found.phi, found.points, found.feature, strict=True):
            assert phi == pytest.approx(expected[end][0], abs=1e-14)
            np.testing.assert_allclose(point, expected[end][1], atol=1e-14)
        if expected:
            np.testing.assert_array_equal(found.normal, N)
    assert counts == {0, 1, 2}
