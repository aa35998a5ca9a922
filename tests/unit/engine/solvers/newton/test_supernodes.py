"""Supernodes hold what elimination fills, in an order that fills less than an envelope has."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from interpreted import interpreted, records
from test_envelope import DOF, GRAPHS, contacts_of

from lavendersim.engine.solvers.newton import envelope, supernodes
from lavendersim.engine.solvers.newton.envelope import allocate_envelope
from lavendersim.engine.solvers.newton.supernodes import (
    CHOSEN,
    COUNT,
    ENTRIES,
    allocate_elimination,
)
from lavendersim.engine.spec import Spec

lay_out, find, number = (
    interpreted(one)
    for one in (envelope.lay_out, supernodes.find_supernodes, supernodes.number_by_supernodes)
)
SPEC = Spec(effects=("friction", "newton", "rotation", "supernodes"), solver="adaptive")


def grid(n: int) -> tuple[int, list[tuple[int, int]]]:
    """Return n by n bodies, each beside its neighbours."""
    pairs = [(n * i + j, n * i + j + 1) for i in range(n) for j in range(n - 1)]
    return n * n, pairs + [(n * i + j, n * (i + 1) + j) for i in range(n - 1) for j in range(n)]


BOARD = (*grid(5), ())
# Whose bodies touch no other: each is a supernode by itself.
ALONE = (4, [(0, 1), (0, 2), (0, 3)], (0,))
EVERY = {**GRAPHS, "board": BOARD, "alone on a floor": ALONE}


def workspace_of(bodies: int, contacts: int, capacity: int):
    """Return the arrays of both factors."""
    elimination = allocate_elimination(bodies, contacts, capacity)
    return allocate_envelope(bodies, contacts, capacity, upper=capacity, elimination=elimination)


def eliminated(bodies: int, pairs, fixed=(), capacity: int | None = None):
    """Return the workspace numbered by supernodes, how many bodies it has, and their cost."""
    rows = contacts_of(pairs, fixed)
    room = DOF * DOF * bodies * bodies if capacity is None else capacity
    workspace = workspace_of(bodies, len(rows), room)
    size, _, envelope_work = lay_out(records(rows), len(rows), workspace)
    work = find(size, workspace)
    if work < inf:
        number(size, workspace)
        workspace.elimination.nodes.outcome[CHOSEN] = 1
    return workspace, size, work, envelope_work


def filled_in(workspace, size: int, pairs, fixed) -> np.ndarray:
    """Return where dense elimination of the graph, in the order found, has anything."""
    there = np.eye(size, dtype=bool)
    for a, b in pairs:
        if a not in fixed and b not in fixed:
            p, q = workspace.position[a], workspace.position[b]
            there[p, q] = there[q, p] = True
    for p in range(size):
        later = p + 1 + np.flatnonzero(there[p, p + 1 :])
        there[np.ix_(later, later)] = True
    return there


@pytest.mark.parametrize("graph", EVERY)
def test_panels_hold_all_that_elimination_fills(graph: str) -> None:
    bodies, pairs, fixed = EVERY[graph]
    workspace, size, work, _ = eliminated(bodies, pairs, fixed)
    nodes = workspace.elimination.nodes
    touched = {k for pair in pairs for k in pair} - set(fixed)
    assert {int(k) for k in workspace.visited[:size]} == touched
    assert all(workspace.position[workspace.visited[p]] == p for p in range(size))
    held = np.zeros((size, size), dtype=bool)
    entries, counted = 0, 0
    for s in range(nodes.outcome[COUNT]):
        members = nodes.members[nodes.begin[s] : nodes.begin[s + 1]]
        own = range(nodes.first[s], nodes.first[s + 1])
        assert [*members[: len(own)]] == [*own]
        assert (np.diff(members) > 0).all()
        assert nodes.panel[s] == entries
        entries += DOF * DOF * len(own) * len(members)
        for k, p in enumerate(own):
            assert nodes.of[p] == s
            held[p, members[k:]] = True
        # By pivots: each is taken from the rows below it, half of each of those.
        below = [DOF * len(members) - k for k in range(DOF * len(own))]
        counted += sum(n * n / 2 for n in below)
    needed = np.triu(filled_in(workspace, size, pairs, fixed))
    assert not (needed & ~held).any()
    assert nodes.outcome[ENTRIES] == entries
    # The sum of n^2 / 2 against its integral.
    assert work == pytest.approx(counted, rel=0.3)


def test_what_is_found_of_a_graph_stays_while_it_stands() -> None:
    bodies, pairs, _ = BOARD
    rows = contacts_of(pairs)
    workspace, size, work, _ = eliminated(bodies, pairs)
    nodes, visited = workspace.elimination.nodes, workspace.visited.copy()
    nodes.place[:] = -7  # any search would write it
    lay_out(records(rows), len(rows), workspace)
    assert find(size, workspace) == work
    number(size, workspace)
    assert (nodes.place == -7).all()
    assert (workspace.visited == visited).all()
    # A body that does not move is another graph, and the same one again is the same order.
    other = contacts_of(pairs, (12,))
    size_without, _, _ = lay_out(records(other), len(other), workspace)
    assert find(size_without, workspace) < work
    lay_out(records(rows), len(rows), workspace)
    assert find(size, workspace) == work
    number(size, workspace)
    assert (workspace.visited == visited).all()
