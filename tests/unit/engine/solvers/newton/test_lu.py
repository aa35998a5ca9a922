"""L U by envelope solves what numpy solves, of matrices that are not symmetric."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted
from test_envelope import DOF, GRAPHS, laid_out

from lavendersim.engine.solvers.newton import lu

factorise, solve = interpreted(lu.factorise_lu), interpreted(lu.solve_lu)


def filled(graph: str, rng: np.random.Generator):
    """Return a workspace with a matrix drawn within its envelope, and the same dense."""
    bodies, pairs, fixed = GRAPHS[graph]
    workspace, size, _, _ = laid_out(bodies, pairs, fixed)
    workspace = workspace._replace(upper=np.zeros_like(workspace.values))
    dense = np.zeros((DOF * size, DOF * size))
    for row in range(DOF * size):
        begin, at = DOF * workspace.first[row // DOF], workspace.start[row]
        below, above = rng.normal(size=(2, row - begin + 1))
        below[-1] = above[-1] = 20.0  # as much as lies beside it
        dense[row, begin : row + 1] = workspace.values[at : at + row - begin + 1] = below
        dense[begin : row + 1, row] = workspace.upper[at : at + row - begin + 1] = above
    return workspace, size, dense


@pytest.mark.parametrize("graph", GRAPHS)
def test_it_solves_what_dense_algebra_solves(graph: str, rng) -> None:
    workspace, size, dense = filled(graph, rng)
    assert factorise(size, workspace)
    x = rng.normal(size=DOF * size)
    expected = np.linalg.solve(dense, x)
    solve(size, workspace, x)
    # Round-off of some forty rows, of a condition below 10.
    np.testing.assert_allclose(x, expected, atol=1e-14)


def test_a_pivot_that_is_none_is_said(rng) -> None:
    workspace, size, _ = filled("tower on a floor", rng)
    workspace.values[workspace.start[0]] = 0.0
    assert not factorise(size, workspace)
