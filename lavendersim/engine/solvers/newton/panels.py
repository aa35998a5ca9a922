"""L U, or L D L^T, of a matrix over bodies by supernodes (`supernodes`).

    upper   rows of a panel: A[k, j], j >= k        lower   its columns, as rows: A[j, k]
Both halves go the same way, each by the other's factors:
    upper[i, j] -= lower[k, i] / D_k upper[k, j]    lower[i, j] -= upper[k, i] / D_k lower[k, j]
and a symmetric matrix is both halves at once. What is left of a panel to its border is subtracted
from the panels of those bodies at once. Six pivots change six rows along the whole of them: rows
are contiguous, so that several of their entries are computed at a time, without a sum of theirs
being reordered.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compile import inner
from .envelope import DOF, dot_rows
from .supernodes import COUNT


class Pivots(NamedTuple):
    """Six rows of a panel, one after the other, and the rows that they take their factors from."""

    half: np.ndarray
    other: np.ndarray
    diagonal: np.ndarray
    at: int  # where the first of the rows starts in both halves
    stride: int  # entries of a row
    row: int  # of the first pivot in `diagonal`


class Destination(NamedTuple):
    """Six rows that change, from a column of the panel on."""

    entries: np.ndarray
    at: int  # where the first of them has that column
    stride: int


@inner
def _reduce_pair(destination, pivots, column, i):
    # Rows i and i + 1 of a destination less what the pivots take from them.
    half, other, diagonal = pivots.half, pivots.other, pivots.diagonal
    stride, d, at = pivots.stride, pivots.row, pivots.at + column
    a, b, count = at + i, at + i + 1, pivots.stride - column
    k2, k3, k4, k5 = 2 * stride, 3 * stride, 4 * stride, 5 * stride
    a0, b0 = other[a] / diagonal[d], other[b] / diagonal[d]
    a1, b1 = other[a + stride] / diagonal[d + 1], other[b + stride] / diagonal[d + 1]
    a2, b2 = other[a + k2] / diagonal[d + 2], other[b + k2] / diagonal[d + 2]
    a3, b3 = other[a + k3] / diagonal[d + 3], other[b + k3] / diagonal[d + 3]
    a4, b4 = other[a + k4] / diagonal[d + 4], other[b + k4] / diagonal[d + 4]
    a5, b5 = other[a + k5] / diagonal[d + 5], other[b + k5] / diagonal[d + 5]
    one = destination.at + i * destination.stride
    two = one + destination.stride
    first, second = destination.entries[one : one + count], destination.entries[two : two + count]
    s0, s1 = half[at : at + count], half[at + stride : at + stride + count]
    s2, s3 = half[at + k2 : at + k2 + count], half[at + k3 : at + k3 + count]
    s4, s5 = half[at + k4 : at + k4 + count], half[at + k5 : at + k5 + count]
    for j in range(count):
        x, y = first[j], second[j]
        x -= a0 * s0[j]
        y -= b0 * s0[j]
        x -= a1 * s1[j]
        y -= b1 * s1[j]
        x -= a2 * s2[j]
        y -= b2 * s2[j]
        x -= a3 * s3[j]
        y -= b3 * s3[j]
        x -= a4 * s4[j]
        y -= b4 * s4[j]
        x -= a5 * s5[j]
        y -= b5 * s5[j]
        first[j], second[j] = x, y


@inner
def _reduce_block(destination, pivots, column):
    # All six rows of a destination.
    for i in range(0, DOF, 2):
        _reduce_pair(destination, pivots, column, i)


@inner
def _reduce_within(pivots, column, i):
    # Row i of six pivots less those before it; they stand from `column` on in the panel.
    half, stride = pivots.half, pivots.stride
    own = pivots.at + i * stride
    for k in range(i):
        row = pivots.at + k * stride
        factor = pivots.other[row + column + i] / pivots.diagonal[pivots.row + k]
        for j in range(column + i, stride):
            half[own + j] -= factor * half[row + j]


@inner
def _scatter(destination, nodes, m, end, rows):
    # += six rows, of which six columns go to each of the members from m to the end.
    half, length = destination.entries, DOF * (end - m)
    for k in range(m, end):
        column = destination.at + DOF * nodes.place[nodes.members[k]]
        source = DOF * (k - m)
        for i in range(DOF):
            at = column + i * destination.stride
            for j in range(DOF):
                half[at + j] += rows[i * length + source + j]


@inner
def _push(s, half, other, diagonal, workspace):
    # What the pivots of a supernode take from the panels of its border.
    elimination = workspace.elimination
    nodes, rows = elimination.nodes, elimination.rows
    begin, count = nodes.begin[s], nodes.begin[s + 1] - nodes.begin[s]
    width, stride = nodes.first[s + 1] - nodes.first[s], DOF * count
    panel, last = nodes.panel[s], -1
    for m in range(width, count):
        p = nodes.members[begin + m]
        owner = nodes.of[p]
        if owner != last:
            for k in range(nodes.begin[owner], nodes.begin[owner + 1]):
                nodes.place[nodes.members[k]] = k - nodes.begin[owner]
            last = owner
        column, length = DOF * m, stride - DOF * m
        for j in range(DOF * length):
            rows[j] = 0.0
        for k in range(width):
            d = DOF * (nodes.first[s] + k)
            pivots = Pivots(half, other, diagonal, panel + DOF * k * stride, stride, d)
            _reduce_block(Destination(rows, 0, length), pivots, column)
        wide = DOF * (nodes.begin[owner + 1] - nodes.begin[owner])
        base = nodes.panel[owner] + DOF * (p - nodes.first[owner]) * wide
        _scatter(Destination(half, base, wide), nodes, begin + m, begin + count, rows)


@inner
def factorise_panels(half, other, both, workspace):
    """Replace the matrix by its factor; returns whether no pivot is zero.

    half: entries of upper rows, other: of lower ones; both: they are two arrays. Where they are
    one, every pivot has to be positive.
    """
    nodes, diagonal = workspace.elimination.nodes, workspace.diagonal
    for s in range(nodes.outcome[COUNT]):
        stride = DOF * (nodes.begin[s + 1] - nodes.begin[s])
        first, panel = nodes.first[s], nodes.panel[s]
        for m in range(nodes.first[s + 1] - first):
            own = panel + DOF * m * stride
            column, d = DOF * m, DOF * (first + m)
            for k in range(m):
                at, before = panel + DOF * k * stride, DOF * (first + k)
                pivots = Pivots(half, other, diagonal, at, stride, before)
                _reduce_block(Destination(half, own + column, stride), pivots, column)
                if both:
                    pivots = Pivots(other, half, diagonal, at, stride, before)
                    _reduce_block(Destination(other, own + column, stride), pivots, column)
            for i in range(DOF):
                _reduce_within(Pivots(half, other, diagonal, own, stride, d), column, i)
                if both:
                    _reduce_within(Pivots(other, half, diagonal, own, stride, d), column, i)
                pivot = half[own + i * stride + column + i]
                diagonal[d + i] = pivot
                if not (abs(pivot) > 0.0 if both else pivot > 0.0):
                    return False
        _push(s, half, other, diagonal, workspace)
        if both:
            _push(s, other, half, diagonal, workspace)
    return True


@inner
def solve_panels(half, other, workspace, x):
    """Solve in place: x enters as the right side, leaves as the solution."""
    elimination, diagonal = workspace.elimination, workspace.diagonal
    nodes, local = elimination.nodes, elimination.local
    count = nodes.outcome[COUNT]
    for s in range(count):
        begin, members = nodes.begin[s], nodes.begin[s + 1] - nodes.begin[s]
        stride, d = DOF * members, DOF * nodes.first[s]
        for m in range(members):
            for i in range(DOF):
                local[DOF * m + i] = x[DOF * nodes.members[begin + m] + i]
        for k in range(DOF * (nodes.first[s + 1] - nodes.first[s])):
            known = local[k] / diagonal[d + k]
            row, right = nodes.panel[s] + k * stride, stride - k - 1
            entries, rest = other[row + k + 1 : row + stride], local[k + 1 : stride]
            for j in range(right):
                rest[j] -= entries[j] * known
        for m in range(members):
            for i in range(DOF):
                x[DOF * nodes.members[begin + m] + i] = local[DOF * m + i]
    for s in range(count - 1, -1, -1):
        begin, members = nodes.begin[s], nodes.begin[s + 1] - nodes.begin[s]
        stride, d = DOF * members, DOF * nodes.first[s]
        for m in range(members):
            for i in range(DOF):
                local[DOF * m + i] = x[DOF * nodes.members[begin + m] + i]
        own = DOF * (nodes.first[s + 1] - nodes.first[s])
        for k in range(own - 1, -1, -1):
            row = nodes.panel[s] + k * stride + k + 1
            total = dot_rows(half, row, local, k + 1, stride - k - 1)
            local[k] = (local[k] - total) / diagonal[d + k]
        for m in range(nodes.first[s + 1] - nodes.first[s]):
            for i in range(DOF):
                x[DOF * nodes.members[begin + m] + i] = local[DOF * m + i]
