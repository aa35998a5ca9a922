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

from ...compile import inner
from .envelope import DOF, dot_rows
from .supernodes import COUNT


@inner
def _reduce_pair(target, one, two, source, at, stride, count, other, a, b, diagonal, d):
    # Two rows of the target, from places `one` and `two` on, less six rows of the source from `at`
    # on; a, b: places of the two rows' factors in the other half; d: of the pivots.
    a0, b0 = other[a] / diagonal[d], other[b] / diagonal[d]
    a1, b1 = other[a + stride] / diagonal[d + 1], other[b + stride] / diagonal[d + 1]
    k2, k3, k4, k5 = 2 * stride, 3 * stride, 4 * stride, 5 * stride
    a2, b2 = other[a + k2] / diagonal[d + 2], other[b + k2] / diagonal[d + 2]
    a3, b3 = other[a + k3] / diagonal[d + 3], other[b + k3] / diagonal[d + 3]
    a4, b4 = other[a + k4] / diagonal[d + 4], other[b + k4] / diagonal[d + 4]
    a5, b5 = other[a + k5] / diagonal[d + 5], other[b + k5] / diagonal[d + 5]
    first, second = target[one : one + count], target[two : two + count]
    s0, s1 = source[at : at + count], source[at + stride : at + stride + count]
    s2, s3 = source[at + k2 : at + k2 + count], source[at + k3 : at + k3 + count]
    s4, s5 = source[at + k4 : at + k4 + count], source[at + k5 : at + k5 + count]
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
def _reduce_block(target, place, step, half, other, at, stride, column, diagonal, d):
    # Six rows of the target, the first at `place`, each `step` after the one before: less what the
    # six pivots whose rows start at `at` take from columns `column` on.
    count = stride - column
    for i in range(0, DOF, 2):
        _reduce_pair(
            target, place + i * step, place + (i + 1) * step, half, at + column, stride, count,
            other, at + column + i, at + column + i + 1, diagonal, d,
        )  # fmt: skip


@inner
def _reduce_within(half, other, at, stride, column, i, diagonal, d):
    # Row i of six pivots less those before it.
    own = at + i * stride
    for k in range(i):
        row = at + k * stride
        factor = other[row + column + i] / diagonal[d + k]
        for j in range(column + i, stride):
            half[own + j] -= factor * half[row + j]


@inner
def _scatter(half, base, wide, rows, length, m, end, nodes):
    # += six rows, of which six columns go to each of the members from m on.
    for k in range(m, end):
        column = base + DOF * nodes.place[nodes.members[k]]
        source = DOF * (k - m)
        for i in range(DOF):
            at = column + i * wide
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
            _reduce_block(
                rows, 0, length, half, other, panel + DOF * k * stride, stride, column,
                diagonal, DOF * (nodes.first[s] + k),
            )  # fmt: skip
        wide = DOF * (nodes.begin[owner + 1] - nodes.begin[owner])
        base = nodes.panel[owner] + DOF * (p - nodes.first[owner]) * wide
        _scatter(half, base, wide, rows, length, begin + m, begin + count, nodes)


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
                _reduce_block(
                    half, own + column, stride, half, other, at, stride, column, diagonal, before
                )
                if both:
                    _reduce_block(
                        other, own + column, stride, other, half, at, stride, column, diagonal,
                        before,
                    )  # fmt: skip
            for i in range(DOF):
                _reduce_within(half, other, own, stride, column, i, diagonal, d)
                if both:
                    _reduce_within(other, half, own, stride, column, i, diagonal, d)
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
