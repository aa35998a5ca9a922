"""A factor by supernodes solves what numpy solves, symmetric or not, of the same matrix."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from interpreted import interpreted
from test_supernodes import (
    ALONE,
    BOARD,
    DOF,
    GRAPHS,
    SPEC,
    eliminated,
)

from lavendersim.engine.compile import call
from lavendersim.engine.solvers.newton import factor, panels

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


@pytest.mark.parametrize("symmetric", [True, False], ids=["one half", "two halves"])
def test_compiled_panels_have_the_bits_of_interpreted_ones(symmetric: bool, rng) -> None:
    # Entries side by side are computed as one by one: no sum is reordered.
    bits = []
    state = rng.bit_generator.state
    for factorise, solve in (
        (interpreted(panels.factorise_panels), interpreted(panels.solve_panels)),
        (partial(call, panels.factorise_panels), partial(call, panels.solve_panels)),
    ):
        rng.bit_generator.state = state
        workspace, size, _ = filled("board", rng, symmetric)
        half = workspace.values if symmetric else workspace.upper
        assert factorise(half, workspace.values, not symmetric, workspace)
        x = rng.normal(size=DOF * size)
        solve(half, workspace.values, workspace, x)
        bits.append((x.tobytes(), workspace.diagonal.tobytes()))
    assert bits[0] == bits[1]
