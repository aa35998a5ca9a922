"""A factor by supernodes solves what numpy solves, symmetric or not, of the same matrix."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import drawn, views
from interpreted import interpreted, records
from test_matrix import FRICTIONAL, PAIRS, stiffness
from test_supernodes import (
    ALONE,
    BOARD,
    DOF,
    GRAPHS,
    SPEC,
    eliminated,
    find,
    lay_out,
    number,
    workspace_of,
)

from lavendersim.engine.solvers.newton import factor, panels
from lavendersim.engine.solvers.newton.matrix import make_assemble
from lavendersim.engine.solvers.newton.minimise import make_assemble_mass
from lavendersim.engine.solvers.newton.supernodes import CHOSEN

SOME = {"board": BOARD, "alone": ALONE, **{name: GRAPHS[name] for name in ("ring and a pair",)}}
block_at = interpreted(factor.make_block_at(SPEC))
entry = interpreted(factor.entry)


def filled(graph: str, rng: np.random.Generator, symmetric: bool):
    """Return a workspace with a matrix drawn on a graph, and the same dense."""
    bodies, pairs, fixed = SOME[graph]
    workspace, size, _, _ = eliminated(bodies, pairs, fixed)
    dense = np.zeros((DOF * size, DOF * size))
    own = {(p, p) for p in range(size)}
    tied = [pair for pair in pairs if not {*pair} & {*fixed}]
    places = [sorted(workspace.position[[a, b]])[::-1] for a, b in tied]
    for p, q in own | {(int(p), int(q)) for p, q in places}:
        below, above = rng.normal(size=(2, DOF, DOF))
        if p == q:
            below = np.tril(below, -1) + 40.0 * np.eye(DOF)  # more than lies beside it
            above = np.triu(above, 1) + 40.0 * np.eye(DOF)
        if symmetric:
            above = below.T
        block = block_at(workspace, p, q)
        for i in range(DOF):
            for j in range(i + 1 if p == q else DOF):
                at = entry(block, i, j)
                workspace.values[at] = dense[DOF * p + i, DOF * q + j] = below[i, j]
                workspace.upper[at] = dense[DOF * q + j, DOF * p + i] = above[j, i]
    return workspace, size, dense


@pytest.mark.parametrize("graph", SOME)
def test_the_factors_solve_the_system(graph: str, rng) -> None:
    workspace, size, dense = filled(graph, rng, symmetric=True)
    assert interpreted(factor.make_factorise(SPEC))(size, workspace)
    b = rng.normal(size=DOF * size)
    x = b.copy()
    interpreted(factor.make_solve_factorised(SPEC))(size, workspace, x)
    # Round-off of some hundred rows, of a condition below 10.
    np.testing.assert_allclose(x, np.linalg.solve(dense, b), atol=1e-14)
    determinant = np.sum(np.log(workspace.diagonal[: DOF * size]))
    assert determinant == pytest.approx(np.linalg.slogdet(dense)[1], rel=1e-13)


@pytest.mark.parametrize("graph", SOME)
def test_the_factors_of_two_halves_solve_theirs(graph: str, rng) -> None:
    workspace, size, dense = filled(graph, rng, symmetric=False)
    assert interpreted(factor.make_factorise_lu(SPEC))(size, workspace)
    b = rng.normal(size=DOF * size)
    x = b.copy()
    interpreted(factor.make_solve_lu(SPEC))(size, workspace, x)
    np.testing.assert_allclose(x, np.linalg.solve(dense, b), atol=1e-14)


@pytest.mark.parametrize("wrong", [-1.0, 0.0, np.nan])
def test_a_pivot_that_is_not_positive_is_refused(wrong: float, rng) -> None:
    factorise = interpreted(panels.factorise_panels)
    workspace, _, _ = filled("ring and a pair", rng, symmetric=True)
    last = entry(block_at(workspace, 4, 4), 3, 3)
    workspace.values[last] = wrong
    assert not factorise(workspace.values, workspace.values, False, workspace)
    workspace, _, _ = filled("ring and a pair", rng, symmetric=False)
    first = entry(block_at(workspace, 0, 0), 0, 0)
    workspace.values[first] = workspace.upper[first] = wrong
    # Of two halves a pivot may be negative.
    found = factorise(workspace.upper, workspace.values, True, workspace)
    assert found == (wrong == -1.0)


def test_panels_have_the_matrix_that_an_envelope_has(rng) -> None:
    spec = FRICTIONAL._replace(effects=SPEC.effects)
    scene = drawn(spec, rng, PAIRS)
    scene.contacts["step_n"] = rng.uniform(-0.9, 0.9, len(PAIRS))
    bodies, _, contacts = views(scene)
    dense = []
    for chosen in (0, 1):
        workspace = records(workspace_of(6, len(PAIRS), 2000))
        workspace.values[:] = 7.0  # of the step before
        size, _, _ = lay_out(contacts, len(PAIRS), workspace)
        if chosen:
            find(size, workspace)
            number(size, workspace)
        workspace.elimination.nodes.outcome[CHOSEN] = chosen
        interpreted(make_assemble_mass(spec))(bodies, size, workspace)
        interpreted(make_assemble(spec, stiffness))(contacts, len(PAIRS), size, workspace)
        whole = np.zeros((36, 36))  # by bodies
        tied = {(int(max(p)), int(min(p))) for p in (workspace.position[[*two]] for two in PAIRS)}
        for p, q in {(k, k) for k in range(size)} | {pair for pair in tied if pair[1] >= 0}:
            block = block_at(workspace, p, q)
            a, b = DOF * int(workspace.visited[p]), DOF * int(workspace.visited[q])
            for i in range(DOF):
                for j in range(i + 1 if p == q else DOF):
                    found = workspace.values[entry(block, i, j)]
                    whole[a + i, b + j] = whole[b + j, a + i] = found
        dense.append(whole)
    # The same sums, in the order of the contacts.
    np.testing.assert_array_equal(*dense)
