"""An interior point method on De Saxce's form of the contact problem, scaled by Nesterov and Todd.

    z = A x + b + |z_t| e_n,  x o z = 0,  x and z in |.t| <= .n, with mu x_n and z_n / mu
z is the velocity with De Saxce's shift, so the shift stands beside z and A stays as it is. Central
path x o z = m e; a step (dx, dz) linearises both with Nesterov and Todd's scaling H, z = H x:
    (A + C H) dx = C (m sigma x^-1 - z) - F,   dz = m sigma x^-1 - z - H dx,   C = I - e_n d_z^T
with F = A x + b + |z_t| e_n - z and d_z the direction of z_t. Nothing is regularised: C H does it,
redundant contacts or not. Where friction slides C H is not symmetric and steps may jam at the
boundary; after such a step one follows with the shift frozen, C = I, as if the problem were convex.
It begins from the cone's axis whatever is known: what it finds depends on no other method.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.problems.budget import Budget
from lavendersim.problems.factorise import factorise
from lavendersim.problems.scaled_problem import (
    Reached,
    ScaledProblem,
    multiply,
    scaled_residual,
    velocities,
)
from lavendersim.problems.semismooth_newton import newton_steps

MOST = 80
# A step that leaves a contact too near the boundary is shortened by this, so often.
BACK, TRIALS = 0.8, 12
# A step shorter than this has jammed, and centring by these shares is tried instead [-].
JAMMED, CENTRING = 0.1, (0.5, 1.0, 2.0)
# A length below this gets nowhere; so many in all end it.
NOWHERE, PATIENCE = 1e-3, 12
LEAST_CENTRING = 1e-6
# eps and number of the Newton steps that end it, `semismooth_newton`.
FINISHING_EPS, FINISHING = 1e-6, 10
MIRROR = np.array([1.0, -1.0, -1.0])
TINY = 1e-300


class Strategy(NamedTuple):
    """How a run is controlled: where friction slides none of them always converges."""

    begin: float  # x and z at first, against the largest free velocity
    share: float  # of the way to the boundary that a step may go [-]
    centred: float  # least product x o z of a contact, against the mean [-]
    power: int  # of what a straight step leaves over: the centring, Mehrotra's rule


LONG_STEPS, SHORT_STEPS = Strategy(1.0, 0.995, 0.02, 3), Strategy(1.0, 0.9, 0.1, 1)
STRATEGIES = (
    LONG_STEPS,
    SHORT_STEPS,
    LONG_STEPS._replace(begin=1e4),
    SHORT_STEPS._replace(begin=1e3),
)


class Cones(NamedTuple):
    """The problem on circular cones."""

    blocks: np.ndarray
    b: np.ndarray
    to_impulse: np.ndarray  # (n, 3), x * to_impulse is in the scaled problem's own terms
    keep: np.ndarray  # (n, 3) bool; no tangents where mu is 0
    own: np.ndarray  # indices of the diagonal blocks


class Interior(NamedTuple):
    """Impulses and velocities, each inside its cone."""

    x: np.ndarray  # (n, 3)
    z: np.ndarray  # (n, 3)


class Advanced(NamedTuple):
    """What one step came to."""

    there: Interior | None  # None: the step has no finite direction
    length: float  # [-] share of the direction that was taken
    cost: float  # of the factorisation


def interior_point(p: ScaledProblem, budget: Budget, strategy: Strategy = LONG_STEPS) -> Reached:
    """Return impulses and their residual after at most `MOST` steps and a few of Newton's."""
    frictional = p.mu > 0.0
    cones = _on_circular_cones(p, frictional)
    x, z = np.zeros_like(p.b), np.zeros_like(p.b)
    x[:, 0] = z[:, 0] = strategy.begin
    x[:, 0] *= np.where(frictional, p.mu, 1.0)
    unit = float(np.sqrt((p.b * p.b).sum(axis=1).max()))
    best, least = np.zeros_like(p.b), float("inf")
    shift_frozen, stuck = False, 0
    for _ in range(MOST):
        impulses = unit * cones.to_impulse * x
        residual = scaled_residual(p, impulses, velocities(p, impulses))
        if residual < least:
            best, least = impulses, residual
        if least <= budget.tolerance or budget.spent or stuck > PATIENCE:
            break
        step = _advance(p, cones, Interior(x, z), unit, shift_frozen, strategy)
        budget.step(step.cost, least)
        if step.there is None:
            break
        x, z = step.there
        shift_frozen = not shift_frozen and step.length < JAMMED
        stuck += step.length < NOWHERE
    if least > budget.tolerance:
        return newton_steps(p, best, budget, FINISHING_EPS, FINISHING)
    return Reached(best, least)


def _on_circular_cones(p: ScaledProblem, frictional: np.ndarray) -> Cones:
    to_impulse = np.ones_like(p.b)
    to_impulse[:, 0] /= np.where(frictional, p.mu, 1.0)
    keep = np.ones(p.b.shape, dtype=bool)
    keep[~frictional, 1:] = False
    blocks = p.blocks * to_impulse[p.rows][:, :, None] * to_impulse[p.columns][:, None, :]
    return Cones(blocks, p.b, to_impulse, keep, np.flatnonzero(p.rows == p.columns))


def _advance(
    p: ScaledProblem,
    cones: Cones,
    here: Interior,
    unit: float,
    shift_frozen: bool,
    strategy: Strategy,
) -> Advanced:
    x, z = here
    mean = 0.5 * float((x * z).sum(axis=1).mean())
    side = np.hypot(z[:, 1], z[:, 2])
    frictional = cones.keep[:, 1]
    F = cones.to_impulse * (multiply(p, cones.to_impulse * x) + cones.b / unit) - z
    F[:, 0] += np.where(frictional, side, 0.0)
    F *= cones.keep
    H = _scaling(x, z)
    C = np.tile(np.eye(3), (p.contacts, 1, 1))
    if not shift_frozen:
        C[:, 0, 1:] -= (frictional / np.where(side > 0.0, side, 1.0))[:, None] * z[:, 1:]
    blocks = cones.blocks.copy()
    blocks[cones.own] += C @ H
    factor = factorise(p, blocks, cones.keep)
    inverse = MIRROR * x / np.maximum(_determinant(x), TINY)[:, None]

    def direction(centring: float) -> Interior:
        target = centring * mean * inverse - z
        dx = factor.solve(np.einsum("nij,nj->ni", C, target) - F)
        return Interior(dx, (target - np.einsum("nij,nj->ni", H, dx)) * cones.keep)

    straight, centred = direction(0.0), direction(1.0)
    if not all(np.isfinite(d).all() for d in (*straight, *centred)):
        return Advanced(None, 0.0, factor.cost)
    # Mehrotra's rule: centre by as much as the straight step would leave.
    length = min(1.0, _to_boundary(x, straight.x), _to_boundary(z, straight.z))
    left = ((x + length * straight.x) * (z + length * straight.z)).sum(axis=1).mean()
    centring = min(1.0, max((0.5 * float(left) / mean) ** strategy.power, LEAST_CENTRING))
    best, there = -1.0, here
    for share in (centring, *CENTRING):
        centring = max(centring, share)
        dx, dz = (s + centring * (c - s) for s, c in zip(straight, centred, strict=True))
        length = min(
            1.0, strategy.share * _to_boundary(x, dx), strategy.share * _to_boundary(z, dz)
        )
        for _ in range(TRIALS):
            new = Interior(x + length * dx, z + length * dz)
            if _is_centred(*new, strategy.centred):
                break
            length *= BACK
        if length > 1.5 * best:
            best, there = length, new
        if length > JAMMED:
            break
    return Advanced(there, best, factor.cost)


def _determinant(x: np.ndarray) -> np.ndarray:
    side = np.hypot(x[:, 1], x[:, 2])
    product: np.ndarray = (x[:, 0] - side) * (x[:, 0] + side)
    return product


def _is_centred(x: np.ndarray, z: np.ndarray, centred: float) -> bool:
    products = np.sqrt(np.maximum(_determinant(x) * _determinant(z), 0.0))
    return bool(products.min() >= centred * 0.5 * (x * z).sum(axis=1).mean())


def _scaling(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return Nesterov and Todd's H of every contact, symmetric and positive definite, z = H x."""
    root_x, root_z = (np.sqrt(np.maximum(_determinant(a), TINY)) for a in (x, z))
    unit_x, unit_z = x / root_x[:, None], z / root_z[:, None]
    inner = np.maximum((unit_x * unit_z).sum(axis=1), 1.0)
    w = (MIRROR * unit_x + unit_z) / np.sqrt(2.0 * (1.0 + inner))[:, None]
    H = 2.0 * w[:, :, None] * w[:, None, :] - np.diag(MIRROR)
    scaling: np.ndarray = (root_z / root_x)[:, None, None] * H
    return scaling


def _to_boundary(x: np.ndarray, d: np.ndarray) -> float:
    """Return the length at which x + length d leaves the cone first; infinite if never."""
    a = d[:, 0] ** 2 - d[:, 1] ** 2 - d[:, 2] ** 2
    b = x[:, 0] * d[:, 0] - x[:, 1] * d[:, 1] - x[:, 2] * d[:, 2]
    c = _determinant(x)
    inner = b * b - a * c
    root = np.sqrt(np.maximum(inner, 0.0))
    with np.errstate(all="ignore"):
        lengths = np.concatenate([c / (root - b), -c / (root + b), -x[:, 0] / d[:, 0]])
    meets = np.concatenate([inner >= 0.0, inner >= 0.0, d[:, 0] < 0.0]) & (lengths > 0.0)
    return float(np.min(lengths[meets], initial=np.inf))
