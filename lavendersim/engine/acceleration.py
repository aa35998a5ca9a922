"""Anderson's acceleration of a fixed-point iteration x <- g(x), over plain arrays.

With f = g(x) - x, of the last passes the changes dx and df, the columns df made orthonormal as they
come and dx combined alike:
    x <- x + f - sum (dx + df) (df . f)
so that in what the columns span f is as good as zero, as if it were linear. One column is found a
pass; when there is no room for more they are forgotten.
"""

from __future__ import annotations

from math import sqrt

from .compile import inner

COLUMNS = 16
# Of a column that is left across those before it, at which it tells nothing new [-].
SAME = 1e-8


@inner
def product(a, b):
    """Return the scalar product of two rows."""
    total = 0.0
    for i in range(a.shape[0]):
        total += a[i] * b[i]
    return total


@inner
def note_change(dx, df, count):
    """Make row `count` of both a column of its own; returns how many there are then."""
    size = product(df[count], df[count])
    if size == 0.0:
        return count
    for _ in range(2):  # once more for round-off
        for j in range(count):
            along = product(df[j], df[count])
            for i in range(df.shape[1]):
                df[count, i] -= along * df[j, i]
                dx[count, i] -= along * dx[j, i]
    left = product(df[count], df[count])
    if left <= SAME * SAME * size:
        return count
    scale = 1.0 / sqrt(left)
    for i in range(df.shape[1]):
        df[count, i] *= scale
        dx[count, i] *= scale
    return count + 1


@inner
def advance_by(x, f, dx, df, count):
    """Replace x by the next one, of `count` columns."""
    for i in range(x.shape[0]):
        x[i] += f[i]
    for j in range(count):
        along = product(df[j], f)
        for i in range(x.shape[0]):
            x[i] -= along * (dx[j, i] + df[j, i])
