"""Solutions of small contact problems by enumeration of all sets of pushing rows.

    w = W lambda + q,    0 <= lambda,  0 <= w,  lambda . w = 0

W is the Delassus operator plus compliance, q the velocity every row misses. With redundant rows
(four corners of one face) lambda is not unique; the velocities are.
"""

from __future__ import annotations

from itertools import product

import numpy as np


def solve_by_enumeration(
    w_matrix: np.ndarray, q: np.ndarray, tolerance: float = 1e-10
) -> np.ndarray:
    """Return impulses that satisfy all four conditions; at most 12 rows (4096 sets)."""
    rows = len(q)
    assert rows <= 12
    scale = max(1.0, float(np.max(np.abs(q), initial=0.0)))
    for pushing in product((True, False), repeat=rows):
        active = np.flatnonzero(pushing)
        impulses = np.zeros(rows)
        if len(active):
            part = w_matrix[np.ix_(active, active)]
            impulses[active] = np.linalg.lstsq(part, -q[active], rcond=1e-12)[0]
        if impulses.min(initial=0.0) < -tolerance * scale / np.max(np.diag(w_matrix), initial=1.0):
            continue
        w = w_matrix @ impulses + q
        if w.min(initial=0.0) < -tolerance * scale:
            continue
        if np.all(np.abs(w[active]) <= tolerance * scale):
            return impulses
    raise AssertionError("no set of pushing rows solves this problem")


def natural_map(impulse: np.ndarray, w: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Return |min(scale lambda, w)| for every row, written as a projection."""
    x = impulse * scale
    return np.abs(x - np.maximum(x - w, 0.0))


class Body:
    """Mass and inertia of one body as a 6 x 6 inverse mass matrix in world axes."""

    def __init__(
        self, inverse_mass: float, inverse_inertia: np.ndarray, matrix: np.ndarray
    ) -> None:
        self.inverse = np.zeros((6, 6))
        self.inverse[:3, :3] = inverse_mass * np.eye(3)
        self.inverse[3:, 3:] = matrix @ np.diag(inverse_inertia) @ matrix.T


def jacobian(bodies: int, a: int, b: int, normal: np.ndarray, arms: tuple[np.ndarray, np.ndarray]):
    """Return the row (6 per body) that takes velocities to v_n of B relative to A."""
    row = np.zeros((bodies, 6))
    row[a, :3] -= normal
    row[a, 3:] -= np.cross(arms[0], normal)
    row[b, :3] += normal
    row[b, 3:] += np.cross(arms[1], normal)
    return row.ravel()
