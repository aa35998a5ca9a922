"""The nearest point of the friction cone, by the conditions that make it the nearest.

Moreau, 1962: p is the nearest point of a closed convex cone K to x exactly if p is in K, x - p is
in its polar K°, and p . (x - p) = 0. Here K° = {y: y_n <= -mu |y_t|}.
"""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.problems.residual import project_on_cone

EPS = np.finfo(float).eps
# p is computed by about ten operations on numbers no larger than |x|.
ROUND_OFF = 16 * EPS


def places(mu: float) -> np.ndarray:
    """Return points in every region: inside, outside, beneath, on the borders between."""
    rng = np.random.default_rng(6)
    random = rng.normal(size=(2000, 3)) * 10.0 ** rng.integers(-150, 150, size=(2000, 1))
    special = [[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, -1], [1, mu, 0], [-mu, 1, 0]]
    return np.vstack([random, np.array(special, dtype=float)])


@pytest.mark.parametrize("mu", [0.0, 1e-9, 0.3, 1.0, 40.0, 1e200])
def test_the_projection_satisfies_its_conditions(mu: float) -> None:
    x = places(mu)
    size = np.max(np.abs(x), axis=1)
    # On numbers near 1: squares of the others would overflow. The cone knows no size.
    scale = np.where(size > 0.0, size, 1.0)[:, None]
    p = project_on_cone(x, np.full(len(x), mu)) / scale
    missed = x / scale - p
    steep = np.hypot(1.0, mu)  # both conditions for the cone are taken per unit of its normal
    assert np.all(np.hypot(p[:, 1], p[:, 2]) / steep <= mu / steep * p[:, 0] + ROUND_OFF)
    assert np.all(missed[:, 0] / steep <= -(mu / steep) * np.hypot(*missed[:, 1:].T) + ROUND_OFF)
    assert np.all(np.abs((p * missed).sum(axis=1)) <= ROUND_OFF)


def test_a_point_of_the_cone_stays_and_its_polar_falls_to_the_apex() -> None:
    mu = np.array([0.5, 0.5, 0.0, 0.0])
    points = np.array([[2.0, 0.6, 0.8], [-1.0, 1.2, 1.6], [3.0, 0.0, 0.0], [3.0, 1.0, 0.0]])
    expected = np.array([[2.0, 0.6, 0.8], [0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    assert np.array_equal(project_on_cone(points, mu), expected)


def test_what_is_not_finite_does_not_come_out_as_a_point() -> None:
    points = np.array([[np.nan, 0.0, 0.0], [1.0, np.inf, 0.0], [1.0, 0.0, 0.0]])
    projected = project_on_cone(points, np.ones(3))
    assert np.isnan(projected[:2]).all()
    assert np.array_equal(projected[2], points[2])
