"""The reference solution of a contact problem, as far as independent methods agree on it.

    sweeps             one contact after the other, or along a gradient, by the engine's kernels
    interior_point     from inside the cones, whatever else is known
    semismooth_newton  sweeps, then Newton steps and rounds
Two of these families have to reach a `scaled` residual of 1e-10 on the Coulomb problem as it
stands. Where velocities u of any two that do differ by more than 1e-6 of the longer of |u| and |q|
(lengths over all rows; u may be zero where everything comes to rest), the problem has more than one
solution, and errors against any of them mean nothing. Impulses are never compared: redundant
contacts share them as they like. The last two may end by the same Newton steps; what they end at
was chosen before.
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from lavendersim.engine.contact_problem import SOLVED, ContactProblem, Solution
from lavendersim.problems.residual import contact_velocities, own_scales
from lavendersim.problems.solve import solve

TOLERANCE = 1e-10
AGREEMENT = 1e-6
# Solvers of each family, in the order they are tried, and their sweeps or steps. The first begins
# with no impulses, which may be one of several solutions; the others do not.
FAMILIES = (
    (
        ("projected_gauss_seidel", 10_000),
        ("nonsmooth_conjugate_gradient", 10_000),
        ("accelerated_projected_gradient", 20_000),
    ),
    (("interior_point", 500),),
    (("semismooth_newton", 20_000),),
)
NEEDED = 2

REFERENCED, NON_UNIQUE, UNREFERENCED = "referenced", "non-unique", "unreferenced"


class Reference(NamedTuple):
    """What is true of a problem."""

    kind: str  # REFERENCED, NON_UNIQUE or UNREFERENCED
    status: str  # one sentence with the numbers
    velocities: np.ndarray  # (n, 3) [m/s], u of the solution with the least residual
    solutions: dict[str, Solution]  # the best of each family, by solver
    difference: float  # largest between velocities of those that reached it, relative [-]


@np.errstate(all="ignore")  # of extreme numbers, as in `solve`
def reference(problem: ContactProblem, tolerance: float = TOLERANCE) -> Reference:
    """Solve a problem by every family; `tolerance` is what `scaled` residuals have to reach."""
    starts = (None, *[_along_the_normals(problem)] * (len(FAMILIES) - 1))
    solutions = dict(
        _best(problem, family, tolerance, start)
        for family, start in zip(FAMILIES, starts, strict=True)
    )
    velocities = {s: contact_velocities(problem, f.impulses) for s, f in solutions.items()}
    reached = [name for name, found in solutions.items() if found.status == SOLVED]
    apart = [
        (relative_difference(problem, velocities[a], velocities[b]), f"{a} and {b}")
        for a, b in combinations(reached, 2)
    ]
    difference, pair = max(apart, default=(float("nan"), ""))
    if len(reached) < NEEDED:
        short = [f"{s} reached {f.scaled:.1e}" for s, f in solutions.items() if s not in reached]
        kind, status = UNREFERENCED, f"{', '.join(short)}, not {tolerance:.0e}"
    elif difference > AGREEMENT:
        kind = NON_UNIQUE
        status = f"{pair} both reached {tolerance:.0e}, with velocities {difference:.1e} apart"
    else:
        kind, status = REFERENCED, f"{', '.join(reached)} agree to {difference:.1e}"
    best = min(solutions, key=lambda name: solutions[name].scaled)
    return Reference(kind, f"{kind}: {status}", velocities[best], solutions, difference)


@np.errstate(all="ignore")
def relative_difference(problem: ContactProblem, first: np.ndarray, second: np.ndarray) -> float:
    """Return |u1 - u2| / max(|u1|, |u2|, |q|), 0 where all are 0."""
    longest = max(float(np.linalg.norm(u)) for u in (first, second, problem.q))
    apart = float(np.linalg.norm(first - second))
    if not np.isfinite(apart):
        return float("inf")
    return apart / longest if longest > 0.0 else 0.0


def _along_the_normals(problem: ContactProblem) -> np.ndarray:
    """Return normal impulses, (n, 3), that would change each contact's velocity by |q| alone."""
    own = own_scales(problem)
    impulses = np.zeros((problem.contacts, 3))
    impulses[:, 0] = np.linalg.norm(problem.q) / np.where(own > 0.0, own, np.inf)
    return impulses


def _best(
    problem: ContactProblem,
    family: tuple[tuple[str, int], ...],
    tolerance: float,
    start: np.ndarray | None,
) -> tuple[str, Solution]:
    """Return the first of a family that solves it, or the one that came nearest."""
    tried: dict[str, Solution] = {}
    for solver, sweeps in family:
        tried[solver] = solve(problem, solver, tolerance, sweeps, start)
        if tried[solver].status == SOLVED:
            return solver, tried[solver]
    nearest = min(tried, key=lambda name: tried[name].scaled)
    return nearest, tried[nearest]
