"""A proximal point iteration: convex rounds, each solved by a semismooth Newton method.

De Saxce's shift s = mu |v_t| is frozen for a round, and a proximal term centres it at x^k:
    G(y) = A (P(y) - x^k) + softness (y - x^k) + v^k + s e_n = 0,     x^k+1 = P(y)
With y = x^k - (v^k + s e_n) / softness + A h, A-times the gradient of a convex function of h is G
(for symmetric A; of others only the slope along a step is used). So Newton's method with an exact
search along each step finds y however redundant the contacts are:
    (softness I + L^T A L) z = -L^T G,   dh = -(P(y) - x^k + softness h + L z) / softness
This is the engine's `solvers.newton` with A for the bodies, and its rounds. They begin stiff, where
a solution may be one round away; where that fails, soft, and stiffen.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.engine.solvers.newton.rounds import (
    EXACTNESS,
    FAILURES,
    LENGTHS,
    SLOPE_LEFT,
    STEPS_OF_A_ROUND,
    after_failed,
    after_kept,
    begin_rounds,
    is_at_minimum,
    is_kept,
    is_slow,
)
from lavendersim.problems.budget import Budget
from lavendersim.problems.factorise import factorise
from lavendersim.problems.friction_cone import derivative_root, project
from lavendersim.problems.scaled_problem import (
    Reached,
    ScaledProblem,
    multiply,
    scaled_residual,
    velocities,
)
from lavendersim.problems.semismooth_newton import newton_steps

# Softness of the first round [-].
FIRST_SOFTNESS = 1e-3
# The longest length of a step that is tried [-].
LONGEST = 64.0
# Below this residual a few full Newton steps may end it.
NEAR, FINISHING = 3e-2, 8


class Line(NamedTuple):
    """A step in y and h from where a round is."""

    y: np.ndarray
    h: np.ndarray
    dy: np.ndarray
    dh: np.ndarray
    centre: np.ndarray
    mu: np.ndarray
    softness: float

    def slope(self, length: float) -> float:
        """Return the derivative of the convex function along the step; it grows with the length."""
        impulses = project(self.y + length * self.dy, self.mu) - self.centre
        return float(np.vdot(self.dy, impulses + self.softness * (self.h + length * self.dh)))


def newton_rounds(p: ScaledProblem, x: np.ndarray, budget: Budget, most: int = 60) -> Reached:
    """Return impulses and their residual after rounds of at most so many steps in all."""
    least = residual = scaled_residual(p, x, velocities(p, x))
    rounds, first = begin_rounds(FIRST_SOFTNESS), True
    begun = budget.steps
    while residual > budget.tolerance and budget.steps - begun < most and not budget.spent:
        v, softness = velocities(p, x), rounds.softness
        worth = max(least, budget.tolerance)
        found, impulses = _round(p, x, v, softness, EXACTNESS * softness * worth * worth, budget)
        reached = scaled_residual(p, impulses, velocities(p, impulses))
        if found and is_kept(reached, least, first):
            x, residual = impulses, reached
            if residual < NEAR:
                x, residual = newton_steps(p, x, budget, softness, FINISHING)
            least = min(least, residual)
            rounds = after_kept(rounds)
        else:
            rounds = after_failed(rounds, keeps_cut=rounds.failed == 0)
            if rounds.failed > FAILURES:
                break
        first = False
    return Reached(x, residual)


def _round(
    p: ScaledProblem,
    centre: np.ndarray,
    v: np.ndarray,
    softness: float,
    enough: float,
    budget: Budget,
) -> tuple[bool, np.ndarray]:
    pushed = v.copy()
    pushed[:, 0] += p.mu * np.hypot(v[:, 1], v[:, 2])
    y, h = centre - pushed / softness, np.zeros_like(centre)
    soft = np.full(centre.shape, softness)
    impulses, first = project(y, p.mu), 0.0
    for step in range(STEPS_OF_A_ROUND):
        gradient = impulses - centre + softness * h
        root = derivative_root(y, p.mu)
        reduced = np.matmul(np.matmul(root[p.rows].transpose(0, 2, 1), p.blocks), root[p.columns])
        factor = factorise(p, reduced, (root != 0.0).any(axis=1), soft)
        z = factor.solve(-np.einsum("nji,nj->ni", root, multiply(p, gradient)))
        dh = -(gradient + np.einsum("nij,nj->ni", root, z)) / softness
        dy = multiply(p, dh)
        residual = scaled_residual(p, impulses, velocities(p, impulses))
        budget.step(factor.cost, residual)
        if not np.isfinite(dy).all():
            return False, centre
        if budget.spent:
            return False, impulses
        line = Line(y, h, dy, dh, centre, p.mu, softness)
        slope = line.slope(0.0)
        first = first or slope
        if is_at_minimum(slope, first, 2.0 * enough):  # a step gains half its slope
            return True, project(y + dy, p.mu)
        if is_slow(step, slope, first):
            return False, impulses
        length = _search(line, slope)
        y, h = y + length * dy, h + length * dh
        impulses = project(y, p.mu)
    return False, impulses


def _search(line: Line, slope: float) -> float:
    """Return a length at which next to nothing of the slope at 0 is left."""
    goal = SLOPE_LEFT * abs(slope)
    low, high, at_low, at_high = 0.0, 1.0, slope, line.slope(1.0)
    if abs(at_high) <= goal:
        return high
    while at_high < 0.0 and high < LONGEST:
        low, high, at_low = high, 2.0 * high, at_high
        at_high = line.slope(high)
    length = high
    for trial in range(LENGTHS):
        if trial % 3 == 2 or not at_high > at_low:
            length = 0.5 * (low + high)
        else:
            length = low - (high - low) * at_low / (at_high - at_low)
        slope = line.slope(length)
        if abs(slope) <= goal:
            break
        if slope < 0.0:
            low, at_low = length, slope
        else:
            high, at_high = length, slope
    return length
