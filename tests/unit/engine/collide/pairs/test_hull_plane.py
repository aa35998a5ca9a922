"""A hull touches a plane in its corners within the margin: all of them, or four that span most."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from single_bodies import body, hull, manifold, solid, vertices_of

N, OFFSET = np.array([2.0, -1.0, 2.0]) / 3.0, 0.7
PLANE = body("plane", N, offset=OFFSET)


def test_corners_within_the_margin_touch_by_their_own_names(rng) -> None:
    counts = set()
    for _ in range(40):
        b, hulls = hull(0.4 * rng.normal(size=(9, 3)), matrix=convex.random_rotation(rng))
        lowest = (vertices_of(solid(b, hulls)) @ N).min()
        b["x"], b["y"], b["z"] = (OFFSET - lowest - rng.uniform(-0.02, 0.15)) * N
        found = manifold("hull_plane", PLANE, b, 0.01, hulls)
        corners = vertices_of(solid(b, hulls))
        phi = corners @ N - OFFSET
        near = set(np.flatnonzero(phi <= 0.01).tolist())
        counts.add(len(near))
        assert set(found.feature.tolist()) <= near
        if len(near) <= 4:
            assert set(found.feature.tolist()) == near
        else:
            assert len(found.phi) in (3, 4)
        if near:
            assert int(np.argmin(phi)) in found.feature
            np.testing.assert_array_equal(found.normal, N)
        for k, own, point in zip(found.feature, found.phi, found.points, strict=True):
            assert own == pytest.approx(phi[k], abs=1e-14)
            np.testing.assert_allclose(point, corners[k] - 0.5 * phi[k] * N, atol=1e-14)
    assert {0, 1, 2, 3} <= counts


def test_of_eight_corners_of_a_face_four_carry_it() -> None:
    """The largest of a regular octagon's quadrilaterals is a square, 2 R^2."""
    turn = np.arange(8) * np.pi / 4
    corners = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(8)])
    b, hulls = hull(np.vstack([corners - [0, 0, 0.5], 0.5 * corners + [0, 0, 0.5]]))
    floor = body("plane", (0.0, 0.0, 1.0), offset=float(vertices_of(solid(b, hulls))[:, 2].min()))
    found = manifold("hull_plane", floor, b, 1e-6, hulls)
    assert len(found.phi) == 4
    diagonals = found.points[:, None] - found.points[None]
    assert np.linalg.norm(diagonals, axis=2).max(axis=1) == pytest.approx(2.0, abs=1e-12)
