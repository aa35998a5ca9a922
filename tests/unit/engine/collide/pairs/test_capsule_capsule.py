"""Two capsules are as far apart as their axes, by least squares with bounds, less their radii."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from scipy.optimize import lsq_linear
from single_bodies import body, manifold, solid

R_A, R_B = 0.2, 0.3


def nearest(a, b) -> tuple[np.ndarray, np.ndarray]:
    """Return the nearest points of two axes: |d + r w - s u| is least, |s|, |r| within bounds."""
    one, other = solid(a), solid(b)
    matrix = np.column_stack([-one.matrix[:, 2], other.matrix[:, 2]])
    bound = np.array([one.half[2], other.half[2]])
    d = other.centre - one.centre
    s, r = lsq_linear(matrix, -d, bounds=(-bound, bound), tol=1e-14).x
    return one.centre + s * one.matrix[:, 2], other.centre + r * other.matrix[:, 2]


def test_drawn_capsules_touch_between_the_nearest_points_of_their_axes(rng) -> None:
    """The solver's places are right to some 1e-7, the least distance to their square."""
    for _ in range(120):
        a = body(
            "capsule",
            (R_A, 0, rng.uniform(0.2, 0.6)),
            rng.normal(size=3),
            convex.random_rotation(rng),
        )
        place = solid(a).centre + 0.7 * rng.normal(size=3)
        b = body("capsule", (R_B, 0, rng.uniform(0.2, 0.6)), place, convex.random_rotation(rng))
        found = manifold("capsule_capsule", a, b, 10.0)
        p, q = nearest(a, b)
        distance = np.linalg.norm(q - p)
        assert found.phi == pytest.approx([distance - R_A - R_B], abs=1e-9)
        assert found.feature.tolist() == [0]
        if distance > 0.05:
            np.testing.assert_allclose(found.normal, (q - p) / distance, atol=1e-4)
            on_a, on_b = p + R_A * found.normal, q - R_B * found.normal
            np.testing.assert_allclose(found.points[0], 0.5 * (on_a + on_b), atol=1e-4)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("shift", [0.0, 0.7, -0.7])
def test_parallel_capsules_touch_at_the_ends_of_their_overlap(turned, shift, rng) -> None:
    """A from -0.5 to 0.5 along its axis, B from shift - 0.4 to shift + 0.4, 0.45 apart."""
    matrix = convex.random_rotation(rng)
    other = matrix @ np.diag([1.0, -1.0, -1.0]) if turned else matrix
    centre = rng.normal(size=3)
    a = body("capsule", (R_A, 0, 0.5), centre, matrix)
    n = matrix[:, 0]
    b = body("capsule", (R_B, 0, 0.4), centre + 0.45 * n + shift * matrix[:, 2], other)
    found = manifold("capsule_capsule", a, b)
    np.testing.assert_allclose(found.phi, [-0.05, -0.05], atol=1e-14)
    np.testing.assert_allclose(found.normal, n, atol=1e-14)
    ends = max(-0.5, shift - 0.4), min(0.5, shift + 0.4)
    # A's surface at 0.2 n, B's at 0.15 n
    expected = [centre + s * matrix[:, 2] + 0.175 * n for s in ends]
    np.testing.assert_allclose(found.points, expected, atol=1e-14)
    assert found.feature.tolist() == [1, 2]


def test_one_parallel_end_within_the_margin_touches_alone() -> None:
    """Tilted by 1e-3, ends 0.5 m from the middle are 1 mm apart in height."""
    tilt = convex.matrix_of([1.0, 0.0, 0.5e-3, 0.0])  # z towards x
    a = body("capsule", (R_A, 0, 0.5))
    b = body("capsule", (R_B, 0, 0.5), (0.5 + 1e-4, 0.0, 0.0), tilt)
    found = manifold("capsule_capsule", a, b, 1e-4)
    assert len(found.phi) == 1
    assert found.points[0][2] == pytest.approx(-0.5, abs=1e-3)
    assert found.phi[0] == pytest.approx(1e-4 - 0.5e-3, abs=1e-6)


def test_axes_that_meet_are_parted_across_both_and_one_axis_along_its_x(rng) -> None:
    a = body("capsule", (R_A, 0, 0.5))
    for side in (-1e-16, 1e-16):
        b = body("capsule", (R_B, 0, 0.5), (side, 0.1, 0.2), np.eye(3)[[0, 2, 1]] * [-1, 1, 1])
        found = manifold("capsule_capsule", a, b)
        np.testing.assert_allclose(found.normal, (np.sign(side), 0.0, 0.0), atol=1e-15)
        assert found.phi == pytest.approx([-R_A - R_B], abs=1e-15)
    found = manifold("capsule_capsule", a, body("capsule", (R_B, 0, 0.5)))
    np.testing.assert_array_equal(found.normal, (1.0, 0.0, 0.0))
    np.testing.assert_allclose(found.phi, [-0.5, -0.5], atol=1e-15)


def test_beyond_the_margin_there_is_none() -> None:
    a = body("capsule", (R_A, 0, 0.5))
    for gap, count in ((0.099, 1), (0.101, 0)):
        b = body("capsule", (R_B, 0, 0.5), (0.5 + gap, 0.0, 0.0), np.eye(3)[[0, 2, 1]] * [-1, 1, 1])
        assert len(manifold("capsule_capsule", a, b, 0.1).phi) == count
