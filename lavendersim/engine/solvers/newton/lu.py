"""L U of a matrix over bodies that is not symmetric, kept by envelope (`envelope`).

What lies below the diagonal, with it, is in `values`, row by row; what lies above it is in `upper`,
column by column, laid out alike: both halves have the same envelope, since bodies push each other.
Without pivots: masses on the diagonal keep them from zero but where friction jams.
"""

from __future__ import annotations

from ...compile import inner
from .envelope import DOF, dot_rows, solve_lower


@inner
def factorise_lu(bodies, workspace):
    """Replace the matrix by L (unit diagonal not stored) and U; returns whether there is one."""
    values, upper, start = workspace.values, workspace.upper, workspace.start
    diagonal = workspace.diagonal
    for row in range(DOF * bodies):
        begin = DOF * workspace.first[row // DOF]
        base = start[row]
        for column in range(begin, row):
            other = DOF * workspace.first[column // DOF]
            low = max(begin, other)
            length = column - low
            at = base + column - begin
            if length > 0:
                own, across = base + low - begin, start[column] + low - other
                values[at] -= dot_rows(values, own, upper, across, length)
                upper[at] -= dot_rows(upper, own, values, across, length)
            values[at] /= diagonal[column]
        pivot = values[base + row - begin]
        pivot -= dot_rows(values, base, upper, base, row - begin)
        diagonal[row] = pivot
        if not abs(pivot) > 0.0:
            return False
    return True


@inner
def solve_lu(bodies, workspace, x):
    """Solve in place: x enters as the right side, leaves as the solution."""
    upper, start, diagonal = workspace.upper, workspace.start, workspace.diagonal
    solve_lower(bodies, workspace, x)
    for row in range(DOF * bodies - 1, -1, -1):
        begin = DOF * workspace.first[row // DOF]
        x[row] /= diagonal[row]
        known = x[row]
        for column in range(begin, row):
            x[column] -= upper[start[row] + column - begin] * known
