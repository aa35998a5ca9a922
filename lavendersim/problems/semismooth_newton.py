"""Semismooth Newton steps on the natural map of the contact problem, regularised.

    F(x) = x - P(y),  y = x - v - mu |v_t| e_n,  v = A x + b       (De Saxce's form)
Each step solves a neighbouring problem, with eps times the change of x added to the velocities:
    d = -F + P' ((1 - eps) d - A' d),   A' = (I + mu e_n d_v^T) A,  d_v the direction of v_t
With P' = L L^T (`friction_cone`) and d = -F + L z only as many unknowns are left as contacts can
still use: none where one opens, two where it slides, three where it sticks:
    (I - (1 - eps) L^T L + L^T A' L) z = -L^T ((1 - eps) F - A' F)
eps, as in Levenberg's and Marquardt's method, makes redundant contacts harmless: it falls when a
step helps and grows when none of its lengths does. It moves no solution.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.problems.budget import Budget
from lavendersim.problems.factorise import factorise
from lavendersim.problems.friction_cone import derivative_root, project
from lavendersim.problems.scaled_problem import (
    Reached,
    ScaledProblem,
    scaled_residual,
    velocities,
)

# eps at most: a step is then a short one along -F; and at least: above round-off of A [-].
LARGEST, LEAST = 10.0, 1e-10
# eps after a step that did not help, one that helped, and one that halved F [-].
GROWS, FALLS, FALLS_FAST = 10.0, 0.5, 0.1
LENGTHS = (1.0, 0.5, 0.25)
# A step of length t has to shrink |F| by this share of t [-].
ENOUGH = 1e-3
# So many steps have to bring |F| down to this share, or others may do better.
LOOK_BACK, LOOKED_FOR = 5, 0.5


class Iterate(NamedTuple):
    """Impulses and what follows from them."""

    x: np.ndarray
    v: np.ndarray
    side: np.ndarray  # |v_t|
    y: np.ndarray
    F: np.ndarray
    size: float  # |F|


def iterate_at(p: ScaledProblem, x: np.ndarray) -> Iterate:
    """Return the natural map at x, and what it follows from."""
    v = velocities(p, x)
    side = np.hypot(v[:, 1], v[:, 2])
    y = x - v
    y[:, 0] -= p.mu * side
    missed = x - project(y, p.mu)
    return Iterate(x, v, side, y, missed, float(np.linalg.norm(missed)))


def newton_steps(
    p: ScaledProblem, x: np.ndarray, budget: Budget, eps: float = 1e-2, most: int = 20
) -> Reached:
    """Return impulses and their residual after at most so many steps; |F| never grows."""
    here = iterate_at(p, x)
    residual = scaled_residual(p, x, here.v)
    sizes: list[float] = []
    for step in range(most):
        sizes.append(here.size)
        if step >= LOOK_BACK and here.size > LOOKED_FOR * sizes[step - LOOK_BACK]:
            break
        if residual <= budget.tolerance or budget.spent or eps > LARGEST:
            break
        d, cost = _direction(p, here, eps)
        for length in LENGTHS:
            there = iterate_at(p, here.x + length * d)
            if there.size < here.size * (1.0 - ENOUGH * length):
                if length == 1.0:
                    fast = there.size < 0.5 * here.size
                    eps = max(eps * (FALLS_FAST if fast else FALLS), LEAST)
                here = there
                residual = scaled_residual(p, here.x, here.v)
                break
        else:  # a NaN ends here too
            eps *= GROWS
        budget.step(cost, residual)
    return Reached(here.x, residual)


def _direction(p: ScaledProblem, here: Iterate, eps: float) -> tuple[np.ndarray, float]:
    root = derivative_root(here.y, p.mu)
    blocks = p.blocks.copy()
    away = p.mu / np.where(here.side > 0.0, here.side, 1.0)
    for axis in (1, 2):
        turn = away * here.v[:, axis]
        blocks[:, 0] += turn[p.rows][:, None] * blocks[:, axis]
    pushed = np.zeros_like(here.F)
    np.add.at(pushed, p.rows, np.einsum("mij,mj->mi", blocks, here.F[p.columns]))
    reduced = np.matmul(np.matmul(root[p.rows].transpose(0, 2, 1), blocks), root[p.columns])
    eigenvalues = (root * root).sum(axis=1)  # L's columns are orthogonal
    factor = factorise(p, reduced, eigenvalues > 0.0, 1.0 - (1.0 - eps) * eigenvalues)
    right = np.einsum("nji,nj->ni", root, pushed - (1.0 - eps) * here.F)
    z = factor.solve(right)
    return np.einsum("nij,nj->ni", root, z) - here.F, factor.cost
