"""Hulls of points meet where a linear programme finds a common point, and only there."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog

from lavendersim.geometry.point_sets import hulls_meet


def common_point(one: np.ndarray, other: np.ndarray) -> bool:
    """Feasibility of: weights >= 0 of each set sum to 1 and give the same point."""
    n, m = len(one), len(other)
    equal = np.vstack([np.hstack([one.T, -other.T]), [1.0] * n + [0.0] * m, [0.0] * n + [1.0] * m])
    found = linprog(np.zeros(n + m), A_eq=equal, b_eq=[0.0, 0.0, 0.0, 1.0, 1.0], method="highs")
    return bool(found.status == 0)


@pytest.mark.parametrize("seed", range(60))
def test_as_a_linear_programme_says(seed: int) -> None:
    """Shifts are drawn so that about half of the pairs meet."""
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.uniform(-3, 3)
    one = size * rng.normal(size=(rng.integers(1, 30), 3))
    other = size * (rng.normal(size=(rng.integers(1, 30), 3)) + rng.uniform(0, 2.5))
    assert hulls_meet(one, other) == common_point(one, other)


def test_a_point_on_a_face_meets_and_one_beside_it_does_not() -> None:
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    assert hulls_meet(corners, np.array([[0.5, 0.5, 1.0]]))
    assert not hulls_meet(corners, np.array([[0.5, 0.5, 1.0 + 1e-8]]))
    assert hulls_meet(corners, corners + np.array([1.0, 0.0, 0.0]))
    assert not hulls_meet(corners, corners + np.array([1.001, 0.0, 0.0]))


def test_flat_and_single_sets_are_hulls_too() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    across = np.array([[0.5, 0.5, -1], [0.5, 0.5, 1]], dtype=float)
    assert hulls_meet(square, across)
    assert not hulls_meet(square, across + np.array([1.0, 0.0, 0.0]))
