"""L D L^T by envelope solves what numpy solves; bodies are numbered along their contacts."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.solvers.newton import envelope
from lavendersim.engine.solvers.newton.envelope import DOF, allocate_envelope

CONTACT = [("a", "i8"), ("b", "i8"), ("key", "i8"), ("inv_m_a", "f8"), ("inv_m_b", "f8")]
lay_out, factorise, solve = (
    interpreted(one) for one in (envelope.lay_out, envelope.factorise, envelope.solve_factorised)
)


def contacts_of(pairs, fixed=()) -> np.ndarray:
    """Return contacts of pairs of bodies, two for each pair side by side, as a manifold has."""
    rows = np.zeros(2 * len(pairs), CONTACT)
    for k, (a, b) in enumerate(pairs):
        for row in rows[2 * k : 2 * k + 2]:
            row["a"], row["b"], row["key"] = a, b, k
            row["inv_m_a"], row["inv_m_b"] = float(a not in fixed), float(b not in fixed)
    return rows


def laid_out(bodies: int, pairs, fixed=()):
    rows = contacts_of(pairs, fixed)
    workspace = allocate_envelope(bodies, len(rows), DOF * DOF * bodies * bodies)
    size, entries, work = lay_out(records(rows), len(rows), workspace)
    return workspace, size, entries, work


TOWER = [(k, k + 1) for k in range(6)]
GRAPHS = {
    "tower": (7, TOWER, ()),
    "tower on a floor": (7, TOWER, (0,)),
    "shuffled tower": (7, [(3, 0), (6, 2), (0, 5), (2, 3), (5, 1), (4, 6)], ()),
    "ring and a pair": (9, [(0, 3), (3, 5), (5, 7), (7, 0), (2, 8)], ()),
    "star on a floor": (6, [(0, k) for k in range(1, 6)], (0,)),
}


@pytest.mark.parametrize("graph", GRAPHS)
def test_every_movable_body_has_a_place_and_rows_reach_to_the_first_neighbour(graph: str) -> None:
    bodies, pairs, fixed = GRAPHS[graph]
    workspace, size, entries, work = laid_out(bodies, pairs, fixed)
    touched = {k for pair in pairs for k in pair} - set(fixed)
    assert size == len(touched)
    assert {int(k) for k in workspace.visited[:size]} == touched
    for k in range(bodies):
        position = workspace.position[k]
        assert (workspace.visited[position] == k) if k in touched else position == -1
    lengths = []
    for p in range(size):
        body = int(workspace.visited[p])
        near = [b if a == body else a for a, b in pairs if body in (a, b)]
        places = [int(workspace.position[k]) for k in near if k in touched]
        assert workspace.first[p] == min([p, *places])
        for k in range(DOF):
            assert workspace.start[DOF * p + k] == sum(lengths)
            lengths.append(DOF * (p - workspace.first[p]) + k + 1)
    assert entries == sum(lengths)
    assert work == sum(n * n // 2 for n in lengths)


def test_a_tower_has_short_rows_in_whatever_order_its_bodies_come() -> None:
    for graph in ("tower", "shuffled tower"):
        bodies, pairs, _ = GRAPHS[graph]
        workspace, size, _, _ = laid_out(bodies, pairs)
        assert max(p - workspace.first[p] for p in range(size)) == 1


def filled(workspace, size: int, rng) -> np.ndarray:
    """Write a positive definite matrix with the envelope's pattern, and return it."""
    n = DOF * size
    matrix = np.zeros((n, n))
    for row in range(n):
        begin = DOF * workspace.first[row // DOF]
        matrix[row, begin:row] = rng.normal(size=row - begin)
    matrix += matrix.T
    matrix += np.diag(np.abs(matrix).sum(axis=1) + 1.0)
    for row in range(n):
        begin = DOF * workspace.first[row // DOF]
        at = workspace.start[row]
        workspace.values[at : at + row - begin + 1] = matrix[row, begin : row + 1]
    return matrix


@pytest.mark.parametrize("graph", GRAPHS)
def test_the_factors_solve_the_system(graph: str, rng) -> None:
    workspace, size, _, _ = laid_out(*GRAPHS[graph])
    matrix = filled(workspace, size, rng)
    assert factorise(size, workspace)
    b = rng.normal(size=DOF * size)
    x = b.copy()
    solve(size, workspace, x)
    np.testing.assert_allclose(x, np.linalg.solve(matrix, b), atol=1e-13)
    determinant = np.sum(np.log(workspace.diagonal[: DOF * size]))
    assert determinant == pytest.approx(np.linalg.slogdet(matrix)[1], rel=1e-13)


def test_a_matrix_that_is_not_positive_is_refused(rng) -> None:
    workspace, size, _, _ = laid_out(*GRAPHS["tower"])
    filled(workspace, size, rng)
    workspace.values[workspace.start[20] + 20 - DOF * workspace.first[3]] = -1.0
    assert not factorise(size, workspace)
    filled(workspace, size, rng)
    workspace.values[workspace.start[5] + 5] = np.nan
    assert not factorise(size, workspace)
