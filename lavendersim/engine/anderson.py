"""Fixed points x = g(x) by the last rounds together: Anderson's acceleration (1965).

A round takes x to g(x) and leaves the defect f = g(x) - x. Where g moves all of x a little, plain
rounds x <- x + f shrink the error by a constant factor, or let it grow. Of the last rounds the
changes dX of what went in and dF of the defects give the least squares

    min |f - dF s|,    x <- x + f - (dX + dF) s

which ends a linear g of as many eigenvalues as there are columns. Columns are made orthogonal from
the newest to the oldest; one that adds no direction is left out: what round-off and curvature leave
of it would be multiplied by as much as it is shorter than its column.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .compile import kernel
from .spec import Spec

# Rounds that are looked back at, but for where more pay.
DEPTH = 4
# Columns, where no round has been made yet.
NO_ROUND = -1
# A column with less than this share left beside the newer ones adds no direction [-]: it would
# bring what the function is not linear by, and what solves leave, at most tenfold into the next.
NEW = 0.1


class FixedPoint(NamedTuple):
    """What the rounds of a fixed point keep; n numbers of one unit."""

    point: np.ndarray  # (n,) x
    defect: np.ndarray  # (n,) f
    last_point: np.ndarray  # (n,) those of the round before
    last_defect: np.ndarray  # (n,)
    moved: np.ndarray  # (depth, n) dX, newest first
    led_to: np.ndarray  # (depth, n) dF
    moved_basis: np.ndarray  # (depth, n) dX as dF becomes orthogonal
    led_to_basis: np.ndarray  # (depth, n) dF, orthogonal


def allocate_fixed_point(size: int, depth: int = DEPTH) -> FixedPoint:
    """Return the arrays of a fixed point of so many numbers; depth: rounds looked back at."""
    rows = [np.zeros(size) for _ in range(4)]
    return FixedPoint(*rows, *(np.zeros((depth, size)) for _ in range(4)))


def make_bring_on(spec: Spec) -> Any:
    """Return `kernel(fixed_point, size, columns) -> columns`: its `point` becomes the next.

    size: numbers in use; columns: of the rounds before, NO_ROUND at first.
    """

    def push_column(rounds, size, columns):
        moved, led_to = rounds.moved, rounds.led_to
        if columns > NO_ROUND:
            columns = min(columns + 1, moved.shape[0])
            for k in range(columns - 1, 0, -1):
                for i in range(size):
                    moved[k, i], led_to[k, i] = moved[k - 1, i], led_to[k - 1, i]
            for i in range(size):
                moved[0, i] = rounds.point[i] - rounds.last_point[i]
                led_to[0, i] = rounds.defect[i] - rounds.last_defect[i]
        else:
            columns = 0
        for i in range(size):
            rounds.last_point[i], rounds.last_defect[i] = rounds.point[i], rounds.defect[i]
        return columns

    push_column = kernel(push_column, spec)

    def orthogonalise(rounds, size, columns):
        # Columns of dX take part in what is done to those of dF.
        moved, led_to = rounds.moved_basis, rounds.led_to_basis
        for k in range(columns):
            before, after = 0.0, 0.0
            for i in range(size):
                moved[k, i], led_to[k, i] = rounds.moved[k, i], rounds.led_to[k, i]
                before += led_to[k, i] * led_to[k, i]
            for j in range(k):
                along, squared = 0.0, 0.0
                for i in range(size):
                    along += led_to[j, i] * led_to[k, i]
                    squared += led_to[j, i] * led_to[j, i]
                if squared > 0.0:
                    share = along / squared
                    for i in range(size):
                        led_to[k, i] -= share * led_to[j, i]
                        moved[k, i] -= share * moved[j, i]
            for i in range(size):
                after += led_to[k, i] * led_to[k, i]
            if not after > NEW * NEW * before:
                for i in range(size):
                    led_to[k, i], moved[k, i] = 0.0, 0.0

    orthogonalise = kernel(orthogonalise, spec)

    def bring_on(rounds, size, columns):
        columns = push_column(rounds, size, columns)
        orthogonalise(rounds, size, columns)
        moved, led_to = rounds.moved_basis, rounds.led_to_basis
        for i in range(size):
            rounds.point[i] += rounds.defect[i]
        for k in range(columns):
            along, squared = 0.0, 0.0
            for i in range(size):
                along += led_to[k, i] * rounds.defect[i]
                squared += led_to[k, i] * led_to[k, i]
            if squared > 0.0:
                share = along / squared
                for i in range(size):
                    rounds.point[i] -= share * (moved[k, i] + led_to[k, i])
        return columns

    return kernel(bring_on, spec)
