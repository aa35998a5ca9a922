"""LU factorisation of a scaled problem's linear system, with its nominal cost (`budget`).

    (diagonal + S^T M S) z = right,    S picks the rows that are kept
By scipy's LU decompositions: a full one for small systems, SuperLU for the others.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy import linalg, sparse
from scipy.sparse.linalg import splu

from lavendersim.problems.scaled_problem import ScaledProblem

# Up to this size [rows] a full decomposition is faster. Of larger ones, however full, the library
# makes several threads, which wait for each other actively: on a busy machine 20 times as long.
SMALL = 100
# Cost of a multiplication in each decomposition, and of an entry when filling [ns].
IN_FULL, IN_SPARSE, ENTRY = 0.1, 0.2, 10.0
AXES = np.arange(3)


class Factor(NamedTuple):
    """A factorised system."""

    solve: Callable[[np.ndarray], np.ndarray]  # right side (n, 3) -> (n, 3), 0 where not kept
    cost: float  # [ns], `budget`


def factorise(
    p: ScaledProblem, blocks: np.ndarray, keep: np.ndarray, diagonal: np.ndarray | None = None
) -> Factor:
    """Factorise; `blocks` (m, 3, 3), `keep` (n, 3) bool, `diagonal` (n, 3).

    A singular system has solutions that are not finite.
    """
    kept = np.flatnonzero(keep)
    size = len(kept)
    place = np.full(keep.size, -1)
    place[kept] = np.arange(size)
    i = np.broadcast_to(place[3 * p.rows[:, None] + AXES][:, :, None], blocks.shape)
    j = np.broadcast_to(place[3 * p.columns[:, None] + AXES][:, None, :], blocks.shape)
    entry = (i >= 0) & (j >= 0)
    i, j, values = i[entry], j[entry], blocks[entry]
    if diagonal is not None:
        own = np.arange(size)
        i, j = np.concatenate([i, own]), np.concatenate([j, own])
        values = np.concatenate([values, diagonal.ravel()[kept]])
    if size <= SMALL:
        solution, cost = _full(size, i, j, values)
    else:
        solution, cost = _sparse(size, i, j, values)

    def solve(right: np.ndarray) -> np.ndarray:
        z = np.zeros(keep.size)
        if size:
            z[kept] = solution(right.ravel()[kept])
        return z.reshape(-1, 3)

    return Factor(solve, cost + ENTRY * blocks.size)


Solve = Callable[[np.ndarray], np.ndarray]


def _full(size: int, i: np.ndarray, j: np.ndarray, values: np.ndarray) -> tuple[Solve, float]:
    matrix = np.zeros((size, size), order="F")
    np.add.at(matrix, (i, j), values)
    if size == 0 or not np.isfinite(values).all():
        return _nothing, 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", linalg.LinAlgWarning)  # seen in the solution
        factors = linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)

    def solution(right: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            z: np.ndarray = linalg.lu_solve(factors, right, check_finite=False)
        return z

    return solution, IN_FULL * size**3 / 3.0


def _sparse(size: int, i: np.ndarray, j: np.ndarray, values: np.ndarray) -> tuple[Solve, float]:
    matrix = sparse.csc_matrix((values, (i, j)), shape=(size, size))
    try:
        # The pattern is symmetric and the diagonal is heavy: ordered and pivoted as such.
        factors = splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.01,
            options={"SymmetricMode": True},
        )
    except RuntimeError:  # exactly singular
        return _nothing, float(len(values))
    return factors.solve, IN_SPARSE * factors.nnz**2 / size


def _nothing(right: np.ndarray) -> np.ndarray:
    return np.full_like(right, np.nan)
