"""What an order of elimination makes of the factor: supernodes, their rows, and what they cost.

    supernode   bodies eliminated together, `width` of them, with one border
    panel       its rows of the factor:  [ its own bodies | border ],  6 width x 6 (width + border)
The parent of a supernode has the first body of its border. In postorder the last child stands right
before its parent and joins it where the zeros that it brings cost less than a short panel does.
Bodies are numbered in that order (`position`), and borders ascend.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

import numpy as np

from ...compile import inner
from .envelope import DOF
from .minimum_degree import QuotientGraph, allocate_quotient_graph, eliminate

# A child joins its parent where both then cost no more than so many times what they do apart [-].
JOINED = 1.1
# Bodies of a supernode that joins at up to twice that: short panels take longer than they count.
SHORT, SHORT_JOINED = 4, 2.0


class Supernodes(NamedTuple):
    """Arrays of the supernodes of a graph, and of the graph that they are of."""

    parent: np.ndarray  # (bodies,) of a step, -1: none
    child: np.ndarray  # (bodies,) first child of a step
    sibling: np.ndarray  # (bodies,) the next child of its parent
    width: np.ndarray  # (bodies,) bodies of a step, with those that joined it
    kept: np.ndarray  # (bodies + 1,) steps on the way down, then counts
    top: np.ndarray  # (bodies,) last step of a supernode, which has its border
    first: np.ndarray  # (bodies + 1,) position of a supernode's first body
    of: np.ndarray  # (bodies,) supernode of a position
    begin: np.ndarray  # (bodies + 1,) where a supernode's positions start in `members`
    members: np.ndarray  # (capacity,) positions, ascending: its own, then its border
    owner: np.ndarray  # (capacity,) supernodes of members, by position
    panel: np.ndarray  # (bodies + 1,) where a panel starts among the entries of the factor
    place: np.ndarray  # (bodies,) place of a position among the members of one supernode
    graph_begin: np.ndarray  # (bodies + 1,) the `begin` that all this is of
    graph: np.ndarray  # (2 contacts,) the `neighbours`
    position: np.ndarray  # (bodies,) as `Envelope.position`
    outcome: np.ndarray  # (4,) see below


# Of `outcome`: whether the factor is laid out by supernodes; how many there are, 0: they have no
# room; the bodies they are of, -1: none; the entries of the factor.
CHOSEN, COUNT, SIZE, ENTRIES = range(4)


class Elimination(NamedTuple):
    """What a factor by supernodes works in."""

    quotient: QuotientGraph
    nodes: Supernodes
    work: np.ndarray  # (1,) multiplications
    rows: np.ndarray  # (36 bodies,) rows of a body on their way to another panel
    local: np.ndarray  # (6 bodies,) a right side, by the members of a supernode


def allocate_elimination(bodies: int, contacts: int, entries: int) -> Elimination:
    """Return the arrays for so many bodies, contacts and entries of a factor."""
    capacity = entries // (DOF * DOF)
    sizes = 4 * [bodies] + [bodies + 1, bodies, bodies + 1, bodies, bodies + 1]
    sizes += [capacity + bodies, capacity, bodies + 1, bodies, bodies + 1, 2 * contacts, bodies, 4]
    nodes = Supernodes(*(np.zeros(size, np.int64) for size in sizes))
    nodes.outcome[SIZE] = -1
    return Elimination(
        allocate_quotient_graph(bodies, contacts, capacity),
        nodes,
        np.zeros(1),
        np.zeros(DOF * DOF * bodies),
        np.zeros(DOF * bodies),
    )


@inner
def panel_work(width, border):
    """Return the multiplications that a supernode of so many bodies takes."""
    own, rows = float(DOF * width), float(DOF * (width + border))
    # The sum over pivots of n^2 / 2, n of what is right of each, as an integral.
    rest = rows - own
    return (rows * rows * rows - rest * rest * rest) / 6.0


@inner
def _find_parents(steps, graph, nodes):
    for s in range(steps):
        nodes.child[s] = -1
    for s in range(steps - 1, -1, -1):
        pivot = graph.order[graph.step_begin[s]]
        nodes.width[s] = graph.step_begin[s + 1] - graph.step_begin[s]
        parent = steps
        begin = graph.border_begin[pivot]
        for k in range(begin, begin + graph.border_size[pivot]):
            parent = min(parent, graph.step_of[graph.borders[k]])
        nodes.parent[s] = parent if parent < steps else -1
    # Children from the last to the first, each put before those there are, so that they ascend.
    for s in range(steps - 1, -1, -1):
        parent = nodes.parent[s]
        if parent >= 0:
            nodes.sibling[s] = nodes.child[parent]
            nodes.child[parent] = s


@inner
def _border_of(step, graph):
    return graph.border_size[graph.order[graph.step_begin[step]]]


@inner
def _join(steps, graph, nodes):
    # Postorder; returns how many supernodes there are, with `top` and `first` of each.
    count, filled, before = 0, 0, -1
    for root in range(steps):
        if nodes.parent[root] >= 0:
            continue
        step, down = root, True
        while step >= 0:
            if down and nodes.child[step] >= 0:
                step = nodes.child[step]
                continue
            # All children are done: the last stands right before.
            alone = nodes.width[step]
            joins = False
            if before >= 0 and nodes.parent[before] == step:
                wide, border = nodes.width[before], _border_of(before, graph)
                own = _border_of(step, graph)
                apart = panel_work(wide, border) + panel_work(alone, own)
                limit = SHORT_JOINED if wide + alone <= SHORT else JOINED
                joins = panel_work(wide + alone, own) <= limit * apart
                if joins:
                    nodes.width[step] = wide + alone
            if joins:
                nodes.top[count - 1] = step
            else:
                nodes.top[count], nodes.first[count] = step, filled
                count += 1
            begin = graph.step_begin[step]
            for k in range(begin, begin + alone):
                nodes.of[filled] = count - 1
                nodes.kept[filled] = graph.order[k]
                filled += 1
            before = step
            if nodes.sibling[step] >= 0 and nodes.parent[step] >= 0:
                step, down = nodes.sibling[step], True
            else:
                step, down = nodes.parent[step], False
    nodes.first[count] = filled
    return count


@inner
def _list_members(size, count, graph, nodes):
    # Positions of each supernode, ascending, by a counting sort over all of them.
    first, begin, members, starts = nodes.first, nodes.begin, nodes.members, nodes.kept
    for p in range(size + 1):
        starts[p] = 0
    begin[0] = 0
    for s in range(count):
        pivot = graph.order[graph.step_begin[nodes.top[s]]]
        at = graph.border_begin[pivot]
        for k in range(at, at + graph.border_size[pivot]):
            starts[nodes.position[graph.borders[k]] + 1] += 1
        begin[s + 1] = begin[s] + first[s + 1] - first[s] + graph.border_size[pivot]
    for p in range(size):
        starts[p + 1] += starts[p]
    for s in range(count):
        pivot = graph.order[graph.step_begin[nodes.top[s]]]
        at = graph.border_begin[pivot]
        for k in range(at, at + graph.border_size[pivot]):
            p = nodes.position[graph.borders[k]]
            nodes.owner[starts[p]] = s
            starts[p] += 1
    for s in range(count):
        nodes.place[s] = begin[s]  # where the next of its positions goes
        for p in range(first[s], first[s + 1]):
            members[nodes.place[s]] = p
            nodes.place[s] += 1
    at = 0
    for p in range(size):
        while at < starts[p]:
            s = nodes.owner[at]
            members[nodes.place[s]] = p
            nodes.place[s] += 1
            at += 1


@inner
def _is_known(size, workspace, nodes):
    # Whether the graph is the one that the supernodes are of.
    if nodes.outcome[SIZE] != size:
        return False
    bodies = workspace.position.shape[0]
    for body in range(bodies + 1):
        if workspace.begin[body] != nodes.graph_begin[body]:
            return False
    for k in range(workspace.begin[bodies]):
        if workspace.neighbours[k] != nodes.graph[k]:
            return False
    for body in range(bodies):
        if (workspace.position[body] < 0) != (nodes.position[body] < 0):
            return False
    return True


@inner
def find_supernodes(size, workspace):
    """Find the supernodes of a graph that `lay_out` has gathered; returns multiplications.

    Infinite where they have no room. What a graph has been found to be stays while it stands.
    """
    elimination = workspace.elimination
    graph, nodes = elimination.quotient, elimination.nodes
    if _is_known(size, workspace, nodes):
        return elimination.work[0]
    bodies = workspace.position.shape[0]
    for body in range(bodies + 1):
        nodes.graph_begin[body] = workspace.begin[body]
    for k in range(workspace.begin[bodies]):
        nodes.graph[k] = workspace.neighbours[k]
    for body in range(bodies):
        nodes.position[body] = -1 if workspace.position[body] < 0 else 0
    nodes.outcome[SIZE], nodes.outcome[COUNT] = size, 0
    elimination.work[0] = inf
    steps = eliminate(size, workspace, graph)
    if steps == 0:
        return inf
    _find_parents(steps, graph, nodes)
    count = _join(steps, graph, nodes)
    for p in range(size):
        nodes.position[nodes.kept[p]] = p
    _list_members(size, count, graph, nodes)
    entries, work = 0, 0.0
    for s in range(count):
        width = nodes.first[s + 1] - nodes.first[s]
        all_of_it = nodes.begin[s + 1] - nodes.begin[s]
        nodes.panel[s] = entries
        entries += DOF * DOF * width * all_of_it
        work += panel_work(width, all_of_it - width)
    nodes.panel[count] = entries
    nodes.outcome[COUNT], nodes.outcome[ENTRIES] = count, entries
    if entries <= workspace.values.shape[0]:
        elimination.work[0] = work
    return elimination.work[0]


@inner
def number_by_supernodes(size, workspace):
    """Number the bodies as their supernodes are eliminated."""
    nodes = workspace.elimination.nodes
    for body in range(workspace.position.shape[0]):
        p = nodes.position[body]
        workspace.position[body] = p
        if p >= 0:
            workspace.visited[p] = body
