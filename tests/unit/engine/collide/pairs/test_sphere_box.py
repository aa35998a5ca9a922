"""A sphere's distance from a box is that of its centre: norm outside, nearest face inside."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from single_bodies import body, manifold, vector

R = 0.2


def gradient(box: convex.Box, place: np.ndarray) -> np.ndarray:
    """Return the direction in which the distance of the oracle grows; differences of 1e-6 m."""
    steps = 1e-6 * np.eye(3)
    value = [
        convex.sphere_box_separation(box, place + s, 0.0)
        - convex.sphere_box_separation(box, place - s, 0.0)
        for s in steps
    ]
    return np.array(value) / 2e-6


def test_outside_and_inside_the_point_is_half_way_along_the_distance(rng) -> None:
    inside = 0
    for _ in range(80):
        box = convex.Box(rng.normal(size=3), convex.random_rotation(rng), rng.uniform(0.2, 0.6, 3))
        place = box.centre + rng.choice([0.2, 0.7]) * rng.normal(size=3)
        a, b = body("box", box.half, box.centre, box.matrix), body("sphere", (R, 0, 0), place)
        found = manifold("sphere_box", a, b, 10.0)
        separation = convex.sphere_box_separation(box, place, R)
        inside += separation < -R
        assert found.phi == pytest.approx([separation], abs=1e-14)
        # second order in the step where the distance is smooth: 1e-12 / distance
        np.testing.assert_allclose(found.normal, gradient(box, place), atol=1e-5)
        nearest = place - (R + 0.5 * separation) * found.normal
        np.testing.assert_allclose(found.points[0], nearest, atol=1e-14)
    assert 10 < inside < 70


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_centre_inside_leaves_through_the_nearest_face(axis: int, side: float) -> None:
    half = np.array([0.5, 0.6, 0.7])
    place = np.array([0.02, 0.03, -0.01])
    place[axis] = side * (half[axis] - 0.1)
    found = manifold("sphere_box", body("box", half), body("sphere", (R, 0, 0), place))
    np.testing.assert_array_equal(found.normal, side * np.eye(3)[axis])
    assert found.phi == pytest.approx([-0.1 - R], abs=1e-15)
    expected = place + side * np.eye(3)[axis] * 0.5 * (0.1 - R)  # A's face + 0.1, B's surface - R
    np.testing.assert_allclose(found.points[0], expected, atol=1e-15)


def test_beyond_the_margin_there_is_none() -> None:
    box = body("box", (0.5, 0.5, 0.5))
    for gap, count in ((0.099, 1), (0.101, 0)):
        corner = vector(box[0]) + 0.5 + (R + gap) / np.sqrt(3.0)
        assert len(manifold("sphere_box", box, body("sphere", (R, 0, 0), corner), 0.1).phi) == count
