"""The order in which bodies are eliminated: minimum degree, on the quotient graph.

    a body that is eliminated becomes an element, whose border are the bodies it has tied together
    degree of a body   the others that it shares a contact or an element with
The body of the least degree is next: what its elimination ties together is what the factor fills.
Degrees are bounds from above, |L_e \\ L_p| summed over the elements of a body (Amestoy, Davis and
Duff 1996, AMD). An element within the border of another is absorbed by it, and a body that has no
neighbours but that border is eliminated at once, with the body before: they make one step, a
supernode. Among equals the last that changed is next, so that an order follows from the graph
alone. Borders are kept, for they are the columns of the factor.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compile import inner

# States of a body: an unknown, an element, and what is neither any more.
LIVE, ELEMENT, GONE = range(3)


class QuotientGraph(NamedTuple):
    """Arrays of one elimination; elements have the number of the body that made them."""

    lists: np.ndarray  # (2 contacts,) of each body: its elements, then its other neighbours
    elements: np.ndarray  # (bodies,) how many of a list are elements
    length: np.ndarray  # (bodies,) of a list
    state: np.ndarray  # (bodies,)
    mark: np.ndarray  # (bodies,) the last element whose border a body was found in
    left: np.ndarray  # (bodies,) of an element, size of L_e \ L_p above a stamp
    degree: np.ndarray  # (bodies,)
    head: np.ndarray  # (bodies + 1,) a body of each degree, -1: none
    following: np.ndarray  # (bodies,) the next of the same degree
    before: np.ndarray  # (bodies,) the one before it, -1: none
    kept: np.ndarray  # (bodies,) a list on its way
    order: np.ndarray  # (bodies,) bodies as they are eliminated
    step_of: np.ndarray  # (bodies,) of its elimination
    step_begin: np.ndarray  # (bodies + 1,) where the bodies of a step start in `order`
    border_begin: np.ndarray  # (bodies,) where an element's border starts in `borders`
    border_size: np.ndarray  # (bodies,)
    borders: np.ndarray  # (capacity,) bodies


def allocate_quotient_graph(bodies: int, contacts: int, capacity: int) -> QuotientGraph:
    """Return the arrays for so many bodies, contacts and bodies in borders."""
    sizes = [2 * contacts] + 6 * [bodies] + [bodies + 1] + 5 * [bodies] + [bodies + 1]
    sizes += [bodies, bodies, capacity]
    return QuotientGraph(*(np.zeros(size, np.int64) for size in sizes))


@inner
def _link(graph, body):
    # Put a body first among those of its degree.
    degree = graph.degree[body]
    first = graph.head[degree]
    graph.following[body], graph.before[body] = first, -1
    if first >= 0:
        graph.before[first] = body
    graph.head[degree] = body


@inner
def _unlink(graph, body):
    following, before = graph.following[body], graph.before[body]
    if following >= 0:
        graph.before[following] = before
    if before >= 0:
        graph.following[before] = following
    else:
        graph.head[graph.degree[body]] = following


@inner
def _begin(size, workspace, graph):
    # Every body with its neighbours, each once; who was visited last is last among equals.
    begin, neighbours, mark = workspace.begin, workspace.neighbours, graph.mark
    for degree in range(graph.head.shape[0]):
        graph.head[degree] = -1
    for p in range(size):
        body = workspace.visited[p]
        mark[body], graph.left[body] = -1, 0
    for p in range(size):
        body = workspace.visited[p]
        n = begin[body]
        for k in range(begin[body], begin[body + 1]):
            other = neighbours[k]
            if mark[other] != body:
                mark[other] = body
                graph.lists[n] = other
                n += 1
        graph.state[body], graph.elements[body] = LIVE, 0
        graph.length[body] = graph.degree[body] = n - begin[body]
    for p in range(size - 1, -1, -1):
        body = workspace.visited[p]
        mark[body] = -1
        _link(graph, body)


@inner
def _find_border(pivot, filled, begin, graph):
    # Write the border of a new element, absorb those it is made of; where it ends, -1: no room.
    state, mark, lists, borders = graph.state, graph.mark, graph.lists, graph.borders
    first, capacity = begin[pivot], borders.shape[0]
    mark[pivot] = pivot
    end = filled
    for k in range(first, first + graph.length[pivot]):
        one = lists[k]
        if k - first < graph.elements[pivot]:
            if state[one] == ELEMENT:
                state[one] = GONE
                at = graph.border_begin[one]
                for m in range(at, at + graph.border_size[one]):
                    body = borders[m]
                    if state[body] == LIVE and mark[body] != pivot:
                        if end == capacity:
                            return -1
                        mark[body] = pivot
                        borders[end] = body
                        end += 1
        elif state[one] == LIVE and mark[one] != pivot:
            if end == capacity:
                return -1
            mark[one] = pivot
            borders[end] = one
            end += 1
    return end


@inner
def _measure_elements(filled, end, stamp, begin, graph):
    # left of every element beside the border becomes stamp + the size of what is outside of it.
    for m in range(filled, end):
        body = graph.borders[m]
        for k in range(begin[body], begin[body] + graph.elements[body]):
            one = graph.lists[k]
            if graph.state[one] == ELEMENT:
                if graph.left[one] < stamp:
                    graph.left[one] = stamp + graph.border_size[one]
                graph.left[one] -= 1


@inner
def _renew(body, pivot, stamp, begin, graph):
    # The list of a body at the border; returns how many of its neighbours are outside.
    lists, kept, state = graph.lists, graph.kept, graph.state
    first, outside, n, elements = begin[body], 0, 0, 1
    for k in range(first, first + graph.length[body]):
        one = lists[k]
        if k - first < graph.elements[body]:
            if state[one] == ELEMENT:
                if graph.left[one] > stamp:
                    outside += graph.left[one] - stamp
                    kept[n] = one
                    n += 1
                    elements += 1
                else:  # within the new one
                    state[one] = GONE
        elif state[one] == LIVE and graph.mark[one] != pivot:
            outside += 1
            kept[n] = one
            n += 1
    lists[first] = pivot
    for k in range(n):
        lists[first + 1 + k] = kept[k]
    graph.elements[body], graph.length[body] = elements, n + 1
    return outside


@inner
def eliminate(size, workspace, graph):
    """Eliminate all bodies in turn; return the steps made, 0 where borders have no room.

    size: bodies of `lay_out`, whose neighbours are in the workspace.
    """
    begin, state, degree = workspace.begin, graph.state, graph.degree
    _begin(size, workspace, graph)
    filled, stamp, steps, done, least = 0, 1, 0, 0, 0
    while done < size:
        while graph.head[least] < 0:
            least += 1
        pivot = graph.head[least]
        _unlink(graph, pivot)
        end = _find_border(pivot, filled, begin, graph)
        if end < 0:
            return 0
        state[pivot] = ELEMENT
        graph.step_begin[steps], graph.step_of[pivot] = done, steps
        graph.order[done] = pivot
        done += 1
        for m in range(filled, end):
            _unlink(graph, graph.borders[m])
        _measure_elements(filled, end, stamp, begin, graph)
        border = end - filled
        stays = filled
        for m in range(filled, end):
            body = graph.borders[m]
            outside = _renew(body, pivot, stamp, begin, graph)
            if graph.length[body] == 1:  # no neighbours beside the border
                state[body] = GONE
                graph.step_of[body] = steps
                graph.order[done] = body
                done += 1
            else:
                bound = min(degree[body] + border - 1, outside + border - 1)
                degree[body] = bound
                graph.borders[stays] = body
                stays += 1
        within = border - (stays - filled)
        for m in range(filled, stays):
            body = graph.borders[m]
            degree[body] = max(min(degree[body] - within, size - done - 1), 0)
            least = min(least, degree[body])
            _link(graph, body)
        graph.border_begin[pivot], graph.border_size[pivot] = filled, stays - filled
        stamp += size + 1
        filled = stays
        steps += 1
    graph.step_begin[steps] = done
    return steps
