"""An ellipsoid touches a plane in the one point of its surface that is nearest to it."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from single_bodies import body, manifold, solid

N = np.array([2.0, -1.0, 2.0]) / 3.0
OFFSET = 0.4


def test_the_point_is_half_way_between_plane_and_surface(rng) -> None:
    for _ in range(40):
        half, matrix = rng.uniform(0.1, 0.8, 3), convex.random_rotation(rng)
        centre = rng.normal(size=3)
        b = body("ellipsoid", half, centre, matrix)
        found = manifold("ellipsoid_plane", body("plane", N, offset=OFFSET), b, 10.0)
        phi = N @ centre - OFFSET - np.linalg.norm(half * (matrix.T @ N))
        assert found.phi == pytest.approx([phi], abs=1e-15 * 4)
        np.testing.assert_array_equal(found.normal, N)
        assert found.points[0] @ N == pytest.approx(OFFSET + 0.5 * phi, abs=1e-15 * 4)
        surface = found.points[0] + 0.5 * phi * N
        # On the surface, where its normal is -N: x . D^-2 is along it.
        local = matrix.T @ (surface - centre)
        assert abs(solids.off_surface(solid(b), surface)) < 1e-14
        outward = local / half**2
        np.testing.assert_allclose(outward / np.linalg.norm(outward), -matrix.T @ N, atol=1e-13)


def test_beyond_the_margin_there_is_none() -> None:
    ground = body("plane", (0, 0, 1))
    for gap, count in ((0.099, 1), (0.101, 0), (2.0, 0)):
        b = body("ellipsoid", (0.2, 0.3, 0.1), (0.0, 0.0, 0.1 + gap))
        assert len(manifold("ellipsoid_plane", ground, b, 0.1).phi) == count
