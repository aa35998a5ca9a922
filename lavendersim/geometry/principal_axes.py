"""Eigenvalues and eigenvectors of a symmetric 3x3 matrix: the cyclic method of Jacobi (1846)."""

from __future__ import annotations

import math

from lavendersim.geometry.quaternions import Quaternion, from_axes
from lavendersim.geometry.vectors import Matrix, Vector3

# Off-diagonal elements below this share of the trace are round-off of the sums that made them; to
# follow them would turn symmetric bodies by nothing but that.
NEGLIGIBLE = 1e-14
# Cyclic Jacobi of a 3x3 converges quadratically, in 3 to 5 sweeps.
MOST_SWEEPS = 20


def principal(tensor: Matrix) -> tuple[Vector3, Quaternion]:
    """Return the eigenvalues of a symmetric matrix and the rotation from its eigenvectors' frame.

    Every turn is less than 45 degrees, so that a matrix that is diagonal already keeps its axes,
    their order and their signs.
    """
    a = [list(row) for row in tensor]
    columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    least = NEGLIGIBLE * (abs(a[0][0]) + abs(a[1][1]) + abs(a[2][2]))
    for _ in range(MOST_SWEEPS):
        turned = False
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if abs(a[p][q]) <= least:
                continue
            turned = True
            tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q])
            t = math.copysign(1.0, tau) / (abs(tau) + math.sqrt(1.0 + tau * tau))
            c = 1.0 / math.sqrt(1.0 + t * t)
            s = t * c
            _turn_rows(a, p, q, c, s)
            a = [list(row) for row in zip(*a, strict=True)]  # symmetric: then the columns
            _turn_rows(a, p, q, c, s)
            _turn_rows(columns, p, q, c, s)
        if not turned:
            break
    return (a[0][0], a[1][1], a[2][2]), from_axes(columns)


def _turn_rows(rows: list[list[float]], p: int, q: int, c: float, s: float) -> None:
    rows[p], rows[q] = (
        [c * x - s * y for x, y in zip(rows[p], rows[q], strict=True)],
        [s * x + c * y for x, y in zip(rows[p], rows[q], strict=True)],
    )
