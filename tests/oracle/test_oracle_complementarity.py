"""Enumerated solutions satisfy all four conditions, on problems with and without redundant rows."""

from __future__ import annotations

import numpy as np
import pytest
from complementarity import natural_map, solve_by_enumeration


@pytest.mark.parametrize("rank", [6, 3])
def test_random_problems_are_solved(rank):
    rng = np.random.default_rng(5)
    for _ in range(20):
        rows = rng.normal(size=(6, rank))
        w_matrix = rows @ rows.T
        q = w_matrix @ rng.normal(size=6) + np.abs(rows @ rng.normal(size=rank)) * 0.0
        impulse = solve_by_enumeration(w_matrix, q)
        residual = natural_map(impulse, w_matrix @ impulse + q, np.diag(w_matrix))
        assert residual.max() < 1e-8


def test_two_rows_by_hand():
    # Row 0 must push with 1; row 1 leaves with w = 1/2 - 1/4 and must not push.
    impulse = solve_by_enumeration(np.array([[1.0, -0.25], [-0.25, 1.0]]), np.array([-1.0, 0.5]))
    np.testing.assert_allclose(impulse, [1.0, 0.0], atol=1e-12)
