"""An order of minimum degree fills less than the breadth of a graph, and says if it has no room."""

from __future__ import annotations

from math import inf

import pytest
from test_envelope import DOF
from test_supernodes import BOARD, eliminated, grid

from lavendersim.engine.solvers.newton.supernodes import ENTRIES, SHORT


def test_a_board_costs_less_than_its_envelope() -> None:
    # Rows of an envelope are n bodies long, their cost n^4; of nested halves it grows with n^3.
    _, _, work, by_envelope = eliminated(*grid(12), capacity=100_000)
    _, _, larger, by_larger = eliminated(*grid(24), capacity=1_000_000)
    assert larger / by_larger < 0.7 * work / by_envelope < 0.7


def test_a_star_is_eliminated_from_its_ends() -> None:
    # The middle first would tie all ends to each other; last, it ties none.
    bodies, pairs = 9, [(0, k) for k in range(1, 9)]
    workspace, _, _, _ = eliminated(bodies, pairs)
    assert workspace.position[0] >= bodies - 2  # the last end has the same degree
    blocks = 2 * (bodies - SHORT) + SHORT * SHORT  # the last of them may have joined
    assert workspace.elimination.nodes.outcome[ENTRIES] <= DOF * DOF * blocks


@pytest.mark.parametrize("capacity", [DOF * DOF * 5, DOF * DOF * 40])
def test_what_has_no_room_is_infinitely_dear(capacity: int) -> None:
    _, _, work, _ = eliminated(*BOARD, capacity=capacity)
    assert work == inf
