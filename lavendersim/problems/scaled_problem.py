"""A contact problem without units, scaled by its own diagonal, for methods that factorise.

    r = length x_i s_i,  u = length v_i / s_i,  s_i = 1 / sqrt(tr W_ii / 3),  length = | s q |
    v = A x + b,  A_ij = s_i W_ij s_j,  b = s q / length
Each contact's own scale leaves its cone as it is and takes the mass ratios out of A's diagonal;
`scaled_residual` is that of `residual`, of the problem as it was given.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.problems.friction_cone import project
from lavendersim.problems.residual import own_scales


class ScaledProblem(NamedTuple):
    """n contacts, m blocks, ordered by rows."""

    rows: np.ndarray  # (m,)
    columns: np.ndarray  # (m,)
    blocks: np.ndarray  # (m, 3, 3) of A [-]
    matrix: Any  # A, (3n, 3n), a scipy matrix
    b: np.ndarray  # (n, 3) [-]
    mu: np.ndarray  # (n,)
    s: np.ndarray  # (n,) [kg^(1/2)]
    length: float  # [m/s kg^(1/2)]
    common: float  # tr W / 3n [1/kg]
    q: float  # |q| [m/s]

    @property
    def contacts(self) -> int:
        """How many contacts the problem has."""
        return len(self.mu)


class Reached(NamedTuple):
    """What a method ends with: impulses of a scaled problem, and their distance from solving it."""

    x: np.ndarray  # (n, 3) [-]
    residual: float  # `scaled_residual` [-]


def scale(problem: ContactProblem) -> ScaledProblem:
    """Return the problem without units; every contact can be moved, and q is not 0."""
    own, q = own_scales(problem), problem.q
    s = 1.0 / np.sqrt(own)
    blocks, columns = problem.blocks.copy(), problem.columns
    blocks[problem.row == columns, 0, 0] += problem.gamma
    order = np.lexsort((columns, problem.row))
    rows, columns = problem.row[order], columns[order]
    blocks = blocks[order] * (s[rows] * s[columns])[:, None, None]
    begin = np.searchsorted(rows, np.arange(problem.contacts + 1))
    size = 3 * problem.contacts
    length = float(np.linalg.norm(s[:, None] * q))
    return ScaledProblem(
        rows,
        columns,
        blocks,
        sparse.bsr_matrix((blocks, columns, begin), shape=(size, size)),
        s[:, None] * q / length,
        problem.mu,
        s,
        length,
        float(own.mean()),
        float(np.linalg.norm(q)),
    )


def multiply(p: ScaledProblem, x: np.ndarray) -> np.ndarray:
    """Return A x, (n, 3)."""
    product: np.ndarray = (p.matrix @ x.ravel()).reshape(-1, 3)
    return product


def velocities(p: ScaledProblem, x: np.ndarray) -> np.ndarray:
    """Return v = A x + b, (n, 3)."""
    v: np.ndarray = multiply(p, x) + p.b
    return v


def to_impulses(p: ScaledProblem, x: np.ndarray) -> np.ndarray:
    """Return the impulses r of x, (n, 3) [N s]."""
    impulses: np.ndarray = p.length * p.s[:, None] * x
    return impulses


def from_impulses(p: ScaledProblem, r: np.ndarray) -> np.ndarray:
    """Return x of impulses r, (n, 3)."""
    x: np.ndarray = r / (p.length * p.s[:, None])
    return x


def scaled_residual(p: ScaledProblem, x: np.ndarray, v: np.ndarray) -> float:
    """Return the residual of the given problem [-]; `v` are the velocities of `x`."""
    shifted = v / p.s[:, None]
    shifted[:, 0] += p.mu * np.hypot(shifted[:, 1], shifted[:, 2])
    pushed = p.common * p.s[:, None] * x
    if p.q == 0.0:  # its squares are below the least number: nothing to compare with
        return float("inf")
    off = float(np.linalg.norm(pushed - project(pushed - shifted, p.mu))) * (p.length / p.q)
    return off if np.isfinite(off) else float("inf")
