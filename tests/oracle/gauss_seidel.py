"""Projected Gauss-Seidel on the full matrix of a contact problem: slow and plain.

    r_n <- max(0, r_n - u_n / W_nn),   r_t <- the nearest point of the disc of radius mu r_n to
                                              r_t - u_t / c,  c the largest response along a tangent
one contact after the other, u always the velocity that all impulses so far leave. Its fixed points
are the solutions. It shares no line with the solvers it is compared with.
"""

from __future__ import annotations

import numpy as np


def dense(problem) -> tuple[np.ndarray, np.ndarray]:
    """Return W with gamma on its normal diagonal, (3n, 3n), and q with the targets, (3n,)."""
    size = 3 * len(problem.mu)
    matrix = np.zeros((size, size))
    for column in range(len(problem.mu)):
        for place in range(problem.begin[column], problem.begin[column + 1]):
            row = problem.row[place]
            matrix[3 * row : 3 * row + 3, 3 * column : 3 * column + 3] = problem.blocks[place]
    matrix[::3, ::3] += np.diag(problem.gamma)
    q = problem.free.copy()
    q[:, 0] += problem.target
    return matrix, q.ravel()


def solve_by_gauss_seidel(problem, sweeps: int) -> np.ndarray:
    """Return impulses (n, 3) after so many sweeps from nothing."""
    matrix, q = dense(problem)
    r = np.zeros(len(q))
    for _ in range(sweeps):
        for contact, mu in enumerate(problem.mu):
            n, t = 3 * contact, slice(3 * contact + 1, 3 * contact + 3)
            stiffness = matrix[n, n]
            if stiffness > 0.0:
                r[n] = max(0.0, r[n] - (matrix[n] @ r + q[n]) / stiffness)
            along = np.linalg.eigvalsh((matrix[t, t] + matrix[t, t].T) / 2.0)[-1]
            if along > 0.0:
                sticking = r[t] - (matrix[t] @ r + q[t]) / along
                length = np.hypot(*sticking)
                limit = mu * r[n]
                r[t] = sticking if length <= limit else sticking * (limit / length)
    return r.reshape(-1, 3)
