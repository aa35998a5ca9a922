"""A cylinder stands on an octagon of its cap, lies on the lowest points of its rims, or tips."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from single_bodies import body, manifold, solid

N, OFFSET, R, HALF = np.array([2.0, -1.0, 2.0]) / 3.0, 0.7, 0.3, 0.5
PLANE = body("plane", N, offset=OFFSET)


def lies(matrix: np.ndarray, gap: float, margin: float):
    """Return (manifold, solid) of a cylinder whose lowest point is `gap` above the plane."""
    b = body("cylinder", (R, 0.0, HALF), matrix=matrix)
    height = solids.reach(solid(b), -N)
    centre = (OFFSET + gap + height) * N + np.cross(N, [0.3, 0.1, -0.4])
    b["x"], b["y"], b["z"] = centre
    return manifold("cylinder_plane", PLANE, b, margin), solid(b)


def axis_at(degrees: float, rng) -> np.ndarray:
    """Return a matrix whose z stands at some degrees from N, turned about itself."""
    across = np.cross(N, rng.normal(size=3))
    across /= np.linalg.norm(across)
    z = np.cos(np.radians(degrees)) * N + np.sin(np.radians(degrees)) * across
    x = np.cross(z, rng.normal(size=3))
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


@pytest.mark.parametrize("degrees", [0.0, 5.0, 45.0, 89.0, 90.0, 135.0, 178.0])
def test_points_lie_half_way_between_a_rim_and_the_plane_and_the_lowest_is_there(
    degrees: float, rng
) -> None:
    for _ in range(5):
        found, shape = lies(axis_at(degrees, rng), -1e-3, 0.02)
        assert found.phi.min() == pytest.approx(-1e-3, abs=1e-14)
        np.testing.assert_array_equal(found.normal, N)
        for phi, point in zip(found.phi, found.points, strict=True):
            assert (point - 0.5 * phi * N) @ N == pytest.approx(OFFSET, abs=1e-14)
            local = shape.matrix.T @ (point + 0.5 * phi * N - shape.centre)
            assert np.hypot(local[0], local[1]) == pytest.approx(R, abs=1e-14)
            assert abs(local[2]) == pytest.approx(HALF, abs=1e-14)


def test_standing_and_lying_it_is_held_by_four_and_by_two_points(rng) -> None:
    """On its cap by a square about the axis, of diagonal 2 R; on its side by both rims."""
    for degrees in (0.0, 180.0):
        found, shape = lies(axis_at(degrees, rng), 0.0, 1e-6)
        assert len(found.phi) == 4
        np.testing.assert_allclose(found.phi, 0.0, atol=1e-14)
        local = (found.points - shape.centre) @ shape.matrix
        np.testing.assert_allclose(local[:, :2].mean(axis=0), 0.0, atol=1e-14)
        sides = np.linalg.norm(local[:, None] - local[None], axis=2)
        assert np.sort(sides, axis=1)[:, 1:3] == pytest.approx(R * np.sqrt(2.0), abs=1e-14)
    found, shape = lies(axis_at(90.0, rng), 0.0, 1e-6)
    assert found.feature.tolist() == [8, 9]
    local = (found.points - shape.centre) @ shape.matrix
    np.testing.assert_allclose(local[:, 2], [-HALF, HALF], atol=1e-14)


def test_what_tips_touches_where_it_tips_to_first_and_what_is_above_does_not(rng) -> None:
    found, shape = lies(axis_at(3.0, rng), 0.0, 1e-6)
    assert found.feature.tolist() == [0]
    assert len(lies(axis_at(30.0, rng), 0.011, 0.01)[0].phi) == 0
    assert len(lies(axis_at(30.0, rng), 0.009, 0.01)[0].phi) == 1
    assert shape.kind == "cylinder"


def test_a_level_cap_turns_with_the_body_and_not_with_round_off(rng) -> None:
    matrix = axis_at(0.0, rng)
    one, _ = lies(matrix, 0.0, 1e-6)
    noise = convex.matrix_of([1.0, 1e-9, -1e-9, 0.0])
    other, _ = lies(noise @ matrix, 0.0, 1e-6)
    np.testing.assert_allclose(one.points, other.points, atol=1e-8)
