"""The residual of impulses in a contact problem: natural map and its parts, free of units.

    u  = W r + q                      with gamma on W's normal diagonal and q = free + target e_n
    uh = u + mu |u_t| e_n             De Saxce and Feng, 1998: then  K* > uh  perp  r in K
    natural map, per contact:         c r - P_K(c r - uh)                                   [m/s]
    scaled = | natural map | / |q|    with c = tr W / 3n, the same for all contacts
    local  = | natural map | / |q|    with c = tr W_ii / 3, each contact's own
K is the cone |r_t| <= mu r_n and P_K the nearest point of it. Both are zero exactly at a solution,
and unchanged when contacts are numbered otherwise, tangents turned or units changed: c r, uh and q
are velocities. The lengths run over all rows. Where q = 0, no impulse is the solution and there is
no velocity to compare with: 0 for a natural map of exactly 0, otherwise infinite.

Parts, each as the largest over the contacts, with c the contact's own, all in m/s:
    natural      | c r - P_K(c r - uh) |
    signorini    | min(c r_n, u_n) |
    cone         c | r - P_K(r) |
    dissipation  | c r_t - P_D(c r_t - u_t) |   D: the disc of radius c mu r_n. It is zero where
                 friction dissipates the most it can, Moreau's principle
Numpy alone, no line of the solvers: this judges them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.engine.contact_problem import NOT_FINITE, SOLVED, SPENT, ContactProblem, Solution


class ResidualPart(NamedTuple):
    """The largest violation of one law and who has it."""

    largest: float  # [m/s]
    contact: int


class Residual(NamedTuple):
    """How far impulses are from a solution."""

    scaled: float  # [-]
    local: float  # [-]
    natural: ResidualPart
    signorini: ResidualPart
    cone: ResidualPart
    dissipation: ResidualPart


class ResidualNorms(NamedTuple):
    """The two lengths of the natural map over |q|."""

    scaled: float  # [-]
    local: float  # [-]


def residual(problem: ContactProblem, impulses: np.ndarray) -> Residual:
    """Judge `impulses` (n, 3) [N s]; what is not finite is infinitely far."""
    with np.errstate(over="ignore", invalid="ignore"):
        own = own_scales(problem)
        u = contact_velocities(problem, impulses)
        maps = _natural_maps(own, impulses, u, problem.mu)
        scaled, local = _distances(problem, maps)
        nearest = project_on_cone(impulses, problem.mu)
        parts = (
            np.linalg.norm(maps[1], axis=1),
            np.abs(np.minimum(own * impulses[:, 0], u[:, 0])),
            own * np.linalg.norm(impulses - nearest, axis=1),
            _missing_dissipation(own, impulses, u, problem.mu),
        )
    return Residual(scaled, local, *map(_worst, parts))


def distances(problem: ContactProblem, impulses: np.ndarray) -> ResidualNorms:
    """Return `scaled` and `local` of `impulses` alone, at less than half the cost."""
    with np.errstate(over="ignore", invalid="ignore"):
        u = contact_velocities(problem, impulses)
        return _distances(problem, _natural_maps(own_scales(problem), impulses, u, problem.mu))


def judged(
    problem: ContactProblem,
    impulses: np.ndarray,
    tolerance: float,
    sweeps: int = 0,
    history: np.ndarray | None = None,
) -> Solution:
    """Return the solution that impulses are, with a status that follows from them alone.

    tolerance: `scaled` residual of what is called solved [-]; sweeps and history are passed on.
    """
    scaled, local = distances(problem, impulses)
    status = SOLVED if scaled <= tolerance else SPENT
    if not np.isfinite(impulses).all():
        status = NOT_FINITE
    residuals = np.empty(0) if history is None else history
    return Solution(impulses, sweeps, residuals, status, scaled, local)


def _natural_maps(
    own: np.ndarray, impulses: np.ndarray, u: np.ndarray, mu: np.ndarray
) -> np.ndarray:
    """Return the natural map with the common scale and with each contact's own, (2, n, 3) [m/s]."""
    common = np.full(len(own), own.sum() / max(len(own), 1))
    scales = np.concatenate([common, own])
    twice = (np.concatenate([array, array]) for array in (impulses, u, mu))
    return natural_map(scales, *twice).reshape(2, len(own), 3)


def _distances(problem: ContactProblem, maps: np.ndarray) -> ResidualNorms:
    q = _length(problem.q)
    return ResidualNorms(_ratio(_length(maps[0]), q), _ratio(_length(maps[1]), q))


def own_scales(problem: ContactProblem) -> np.ndarray:
    """Return c = tr W_ii / 3 of every contact, (n,) [1/kg]."""
    diagonal = problem.own_blocks.reshape(-1, 9)
    traces = diagonal[:, 0] + diagonal[:, 4] + diagonal[:, 8]
    scales: np.ndarray = (traces + problem.gamma) / 3.0
    return scales


@np.errstate(over="ignore", invalid="ignore")  # of extreme numbers: what is not finite stays so
def contact_velocities(problem: ContactProblem, impulses: np.ndarray) -> np.ndarray:
    """Return u, (n, 3) [m/s], with what regularisation and targets add to its normal rows."""
    u = problem.q
    u[:, 0] += problem.gamma * impulses[:, 0]
    pushed = np.einsum("mij,mj->mi", problem.blocks, impulses[problem.columns])
    for k in range(3):
        u[:, k] += np.bincount(problem.row, pushed[:, k], problem.contacts)
    return u


def natural_map(
    scales: np.ndarray, impulses: np.ndarray, u: np.ndarray, mu: np.ndarray
) -> np.ndarray:
    """Return c r - P_K(c r - uh), (n, 3) [m/s]; `scales` (n,) [1/kg]."""
    scaled_impulses = scales[:, None] * impulses
    shifted = u.copy()
    shifted[:, 0] += mu * np.hypot(u[:, 1], u[:, 2])
    missed: np.ndarray = scaled_impulses - project_on_cone(scaled_impulses - shifted, mu)
    return missed


def project_on_cone(points: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Return the nearest points of |x_t| <= mu x_n, (n, 3); `mu` (n,)."""
    normal, sides = points[:, 0], points[:, 1:]
    side = np.hypot(sides[:, 0], sides[:, 1])
    with np.errstate(over="ignore", invalid="ignore"):
        inside = side <= mu * normal
        beneath = mu * side <= -normal  # in the polar cone: the apex is nearest
        # Else on the surface, along its generator (cos, sin) in the plane of normal and side.
        hypotenuse = np.hypot(1.0, mu)
        cos, sin = 1.0 / hypotenuse, mu / hypotenuse
        along = cos * normal + sin * side
        turned = sin * along / np.where(side > 0.0, side, 1.0)
    on_surface = np.column_stack([cos * along, turned[:, None] * sides])
    projected: np.ndarray = np.where(
        inside[:, None], points, np.where(beneath[:, None], 0.0, on_surface)
    )
    # A NaN fails every comparison and must not come out as a place on the cone.
    projected[~np.isfinite(points).all(axis=1)] = np.nan
    return projected


def _missing_dissipation(
    scales: np.ndarray, impulses: np.ndarray, u: np.ndarray, mu: np.ndarray
) -> np.ndarray:
    scaled_impulses = scales[:, None] * impulses[:, 1:]
    radius = mu * scales * np.maximum(impulses[:, 0], 0.0)
    trial = scaled_impulses - u[:, 1:]
    length = np.hypot(trial[:, 0], trial[:, 1])
    shrink = np.where(length > radius, radius / np.where(length > 0.0, length, 1.0), 1.0)
    missing: np.ndarray = np.linalg.norm(scaled_impulses - shrink[:, None] * trial, axis=1)
    return missing


def _length(rows: np.ndarray) -> float:
    """Return the Euclidean length of all numbers; squares of small units would underflow."""
    largest = float(np.max(np.abs(rows), initial=0.0))
    if largest == 0.0 or not np.isfinite(largest):
        return largest
    return largest * float(np.linalg.norm(rows / largest))


def _ratio(length: float, q: float) -> float:
    if not np.isfinite(length):
        return float("inf")
    if q > 0.0:
        return length / q
    return 0.0 if length == 0.0 else float("inf")


def _worst(violations: np.ndarray) -> ResidualPart:
    if len(violations) == 0:
        return ResidualPart(0.0, -1)
    contact = int(np.argmax(violations))  # a NaN counts as the largest
    return ResidualPart(float(violations[contact]), contact)
