"""L D L^T of a sparse symmetric matrix over bodies, kept by envelope.

Rows of six, one per body. The matrix is kept by envelope: of each row everything from its first
entry to the diagonal, where fill stays. Bodies are numbered breadth first from an end of their
contact graph (Cuthill and McKee 1969, without the sorting by degree), which keeps rows short: a
tower's are two bodies long, a pyramid's as long as its base.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from ...anderson import FixedPoint, allocate_fixed_point
from ...compile import inner
from ...records import F8, Field, dtype
from .kept_velocities import PLACES

DOF = 6
# Of the six rows of a body: its velocity along world x, y, z, its angular velocity about them.
X, Y, Z, WX, WY, WZ = range(DOF)
# Of the nine rows of a contact: those of body A, of body B, and E' times either's; within each
# those along the normal and the tangents.
OF_A, OF_B, SCALED = 0, 3, 6
N, T1, T2 = range(3)
# Columns of `Envelope.inside`: three of `inside_cones`, six of `begin_again`.
INSIDE = 9
# Mass [kg] and world inertia [kg m^2] of a body.
MASS: Final[list[Field]] = [(name, F8) for name in ("m", "xx", "xy", "xz", "yy", "yz", "zz")]


class Envelope(NamedTuple):
    """Arrays of one factorisation; n bodies, 6 n rows."""

    position: np.ndarray  # (bodies,) row block of a body, -1: not in the system
    visited: np.ndarray  # (bodies,) body at each position
    neighbours: np.ndarray  # (2 * contact capacity,) bodies, by body
    begin: np.ndarray  # (bodies + 1,) where a body's neighbours start
    first: np.ndarray  # (bodies,) first block column of each block row
    start: np.ndarray  # (6 bodies,) where a row's entries start in `values`
    values: np.ndarray  # (capacity,) entries, rows one after the other, diagonal last
    diagonal: np.ndarray  # (6 bodies,) D
    gradient: np.ndarray  # (6 bodies,) g(v), see `minimise`
    step: np.ndarray  # (6 bodies,) of the velocities, along which a length is searched for
    change: np.ndarray  # (6 bodies,) of the velocities in this round: v - v^k
    mass: np.ndarray  # (bodies,) MASS, by position
    rows: np.ndarray  # (9, 6) rows n, t1, t2 of one contact: body A's, body B's, and scaled
    shifts: FixedPoint  # (contacts,), see `shifts`
    upper: np.ndarray  # (capacity,) entries above the diagonal by columns, as `values`; see `lu`
    inside: np.ndarray  # (contacts, INSIDE), see `inside_cones`; no rows where it is not used
    kept: np.ndarray  # (PLACES, bodies, 6) velocities, see `kept_velocities`
    packed: Any = ()  # what sweeps between two calls work in, where they pack contacts
    elimination: Any = ()  # see `supernodes`, where bodies may be eliminated in another order


def allocate_envelope(
    bodies: int,
    contacts: int,
    capacity: int,
    packed: Any = (),
    upper: int = 0,
    inside: int = 0,
    *,
    elimination: Any = (),
) -> Envelope:
    """Return the arrays for so many bodies, contacts and matrix entries.

    upper: entries above the diagonal; inside: contacts of which methods from inside know more.
    """
    rows = DOF * bodies
    return Envelope(
        np.zeros(bodies, np.int64),
        np.zeros(bodies, np.int64),
        np.zeros(2 * contacts, np.int64),
        np.zeros(bodies + 1, np.int64),
        np.zeros(bodies, np.int64),
        np.zeros(rows, np.int64),
        np.zeros(capacity),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(bodies, dtype(MASS)),
        np.zeros((9, DOF)),
        allocate_fixed_point(contacts),
        np.zeros(upper),
        np.zeros((inside, INSIDE)),
        np.zeros((PLACES, bodies, DOF)),
        packed,
        elimination,
    )


@inner
def _gather(contacts, count, workspace):
    # Neighbours of every body that a contact joins to another movable one, by counting sort.
    begin, neighbours, position = workspace.begin, workspace.neighbours, workspace.position
    bodies = position.shape[0]
    for i in range(bodies + 1):
        begin[i] = 0
    for i in range(bodies):
        position[i] = -1
    last = -1
    for c in range(count):
        contact = contacts[c]
        if contact.inv_m_a > 0.0:
            position[contact.a] = -2
        if contact.inv_m_b > 0.0:
            position[contact.b] = -2
        if contact.key != last and contact.inv_m_a > 0.0 and contact.inv_m_b > 0.0:
            begin[contact.a + 1] += 1
            begin[contact.b + 1] += 1
        last = contact.key
    for i in range(bodies):
        begin[i + 1] += begin[i]
    last = -1
    for c in range(count):
        contact = contacts[c]
        if contact.key != last and contact.inv_m_a > 0.0 and contact.inv_m_b > 0.0:
            neighbours[begin[contact.a]] = contact.b
            begin[contact.a] += 1
            neighbours[begin[contact.b]] = contact.a
            begin[contact.b] += 1
        last = contact.key
    for i in range(bodies, 0, -1):
        begin[i] = begin[i - 1]
    begin[0] = 0


@inner
def _walk(root, filled, workspace):
    # Number the component of `root` breadth first from position `filled` on.
    position, visited = workspace.position, workspace.visited
    position[root] = filled
    visited[filled] = root
    head, tail = filled, filled + 1
    while head < tail:
        body = visited[head]
        head += 1
        for k in range(workspace.begin[body], workspace.begin[body + 1]):
            other = workspace.neighbours[k]
            if position[other] == -2:
                position[other] = tail
                visited[tail] = other
                tail += 1
    return tail


@inner
def lay_out(contacts, count, workspace):
    """Number the bodies and lay out the rows; returns (bodies, entries, multiplications).

    The walk runs twice: its last body is an end of the component, a good place to begin.
    """
    _gather(contacts, count, workspace)
    position, visited, first = workspace.position, workspace.visited, workspace.first
    filled = 0
    for root in range(position.shape[0]):
        if position[root] == -2:
            end = _walk(root, filled, workspace)
            far = visited[end - 1]
            for k in range(filled, end):
                position[visited[k]] = -2
            filled = _walk(far, filled, workspace)
    entries, work = 0, 0
    for p in range(filled):
        lowest = p
        body = visited[p]
        for k in range(workspace.begin[body], workspace.begin[body + 1]):
            lowest = min(lowest, position[workspace.neighbours[k]])
        first[p] = lowest
        for k in range(DOF):
            workspace.start[DOF * p + k] = entries
            length = DOF * (p - lowest) + k + 1
            entries += length
            work += length * length // 2
    return filled, entries, work


@inner
def dot_rows(values, i, others, j, length):
    """Return the product of two rows, from places i and j on."""
    # Four sums side by side: a single one would wait for itself at every addition.
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    k = 0
    while k + 4 <= length:
        a += values[i + k] * others[j + k]
        b += values[i + k + 1] * others[j + k + 1]
        c += values[i + k + 2] * others[j + k + 2]
        d += values[i + k + 3] * others[j + k + 3]
        k += 4
    while k < length:
        a += values[i + k] * others[j + k]
        k += 1
    return (a + b) + (c + d)


@inner
def factorise(bodies, workspace):
    """Replace the matrix by L (unit diagonal not stored) and D; returns whether D is positive."""
    values, start, diagonal = workspace.values, workspace.start, workspace.diagonal
    for row in range(DOF * bodies):
        begin = DOF * workspace.first[row // DOF]
        base = start[row]
        # Row of L D first: entries of L scaled by D, column by column.
        for column in range(begin, row):
            other = DOF * workspace.first[column // DOF]
            low = max(begin, other)
            length = column - low
            at = base + column - begin
            if length > 0:
                values[at] -= dot_rows(
                    values, base + low - begin, values, start[column] + low - other, length
                )
        pivot = values[base + row - begin]
        for column in range(begin, row):
            at = base + column - begin
            scaled = values[at]
            values[at] = scaled / diagonal[column]
            pivot -= scaled * values[at]
        diagonal[row] = pivot
        if not pivot > 0.0:
            return False
    return True


@inner
def solve_lower(bodies, workspace, x):
    """Solve with L alone, in place."""
    values, start = workspace.values, workspace.start
    for row in range(DOF * bodies):
        begin = DOF * workspace.first[row // DOF]
        total = x[row]
        for column in range(begin, row):
            total -= values[start[row] + column - begin] * x[column]
        x[row] = total


@inner
def solve_factorised(bodies, workspace, x):
    """Solve in place: x enters as the right side, leaves as the solution."""
    values, start, diagonal = workspace.values, workspace.start, workspace.diagonal
    rows = DOF * bodies
    solve_lower(bodies, workspace, x)
    for row in range(rows):
        x[row] /= diagonal[row]
    for row in range(rows - 1, -1, -1):
        begin = DOF * workspace.first[row // DOF]
        known = x[row]
        for column in range(begin, row):
            x[column] -= values[start[row] + column - begin] * known
