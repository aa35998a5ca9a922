"""Solution of a contact problem by a solver's name, with a status judged from its impulses alone.

Whatever status a solver reports, `solved` follows from `residual`. Contacts that no impulse can
move (both bodies fixed, an empty row of W) are left out of the problem that is solved.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from lavendersim.engine.contact_problem import NOT_FINITE, SOLVED, ContactProblem, Solution
from lavendersim.engine.solvers.catalogue import SOLVERS as KERNELS
from lavendersim.errors import UsageError
from lavendersim.problems.by_kernel import solve_by_kernel
from lavendersim.problems.interior_point import STRATEGIES
from lavendersim.problems.residual import judged, own_scales
from lavendersim.problems.search import Search
from lavendersim.quantities.found import nearest, quoted

Solver = Callable[[ContactProblem, float, int, "np.ndarray | None", bool], Solution]

# Sweeps, or steps, at most where no limit is given. `auto` is limited by `AUTO` instead.
SWEEPS = 10_000
AUTO_SWEEPS = 1_000_000
# What `auto` may spend [ns], `budget`: at least, and by contacts.
AUTO, AUTO_BY_CONTACT = 3e9, 6e6
# Of so many contacts and more `auto` sweeps first, for so much of it [-]: the cost of a sweep grows
# with the number of contacts, that of a factor by more.
MANY, MOST_OF_IT = 2000, 0.8


def _newton(search: Search) -> None:
    """Take turns of sweeps, semismooth Newton steps and rounds."""
    search.open()
    search.go_on()


def _interior_point(search: Search) -> None:
    """Begin inside the cones, one strategy after the other."""
    for strategy in STRATEGIES:
        if not search.over:
            search.interior(strategy)
        if not search.over:
            search.rounds()


def _whatever_does_it(search: Search) -> None:
    if search.problem.contacts >= MANY:
        search.sweep_while_it_pays(MOST_OF_IT)
    search.open()
    search.go_on(STRATEGIES)


def _by_search(
    plan: Callable[[Search], None], least: float = float("inf"), by_contact: float = 0.0
) -> Solver:
    """Return the solver that makes a plan; it counts sweeps and steps alike as `sweeps`.

    least, by_contact: what it may spend [ns], whichever is more.
    """

    def solver(
        problem: ContactProblem,
        tolerance: float,
        sweeps: int,
        start: np.ndarray | None = None,
        history: bool = False,
    ) -> Solution:
        cost = max(least, by_contact * problem.contacts)
        search = Search(problem, tolerance, sweeps, start, history, cost)
        plan(search)
        return search.solution()

    return solver


# `adaptive` chooses by what a scene's bodies allow. The block and coloured variants differ from
# `projected_gauss_seidel` in how they visit bodies: through W all three are the same sweeps.
SOLVERS: dict[str, Solver] = {
    **{name: partial(solve_by_kernel, name) for name in KERNELS if KERNELS[name].solves_matrix},
    "semismooth_newton": _by_search(_newton),
    "interior_point": _by_search(_interior_point),
    "auto": _by_search(_whatever_does_it, AUTO, AUTO_BY_CONTACT),
}


# A problem of extreme numbers has squares and ratios beyond all numbers. What comes of them is
# judged as any other: not finite, or not solved.
@np.errstate(all="ignore")
def solve(
    problem: ContactProblem,
    solver: str = "auto",
    tolerance: float = 1e-8,
    sweeps: int | None = None,
    start: np.ndarray | None = None,
    history: bool = False,
) -> Solution:
    """Return the impulses a solver finds, judged by their residual.

    tolerance: `scaled` residual (`residual`) of what is called solved [-]; sweeps: sweeps, and
    steps of other methods, at most; start: impulses (n, 3) to begin at [N s]; history: keep the
    residual at the start and after every sweep and step.
    Raises UsageError for an unknown solver, with the nearest name.
    """
    if solver not in SOLVERS:
        raise UsageError(f"no solver is called {quoted(solver)}{nearest(solver, SOLVERS)}")
    begin = np.zeros((problem.contacts, 3)) if start is None else np.asarray(start, dtype=float)
    if not all(np.isfinite(numbers).all() for numbers in problem):
        return Solution(begin, 0, np.empty(0), NOT_FINITE, float("inf"), float("inf"))
    moved = own_scales(problem) > 0.0
    if moved.all():
        found = _run(problem, solver, tolerance, sweeps, begin, history)
        return judged(problem, found.impulses, tolerance, found.sweeps, found.history)
    part = _only(problem, moved)
    found = _run(part, solver, tolerance, sweeps, begin[moved], history)
    impulses = np.zeros((problem.contacts, 3))
    impulses[moved] = found.impulses
    solution = judged(problem, impulses, tolerance, found.sweeps, found.history)
    if solution.status == SOLVED:
        return solution
    closing = np.where(moved, 0.0, problem.q[:, 0])
    worst = int(np.argmin(closing))
    if closing[worst] < 0.0:
        return solution._replace(
            status=f"no solution: contact {worst} closes at {-closing[worst]:.3g} m/s "
            "and no impulse can move it"
        )
    return solution


def _run(
    problem: ContactProblem,
    solver: str,
    tolerance: float,
    sweeps: int | None,
    start: np.ndarray,
    history: bool,
) -> Solution:
    if not problem.q.any():  # no contacts, or none that needs an impulse
        residuals = np.zeros(1 if history else 0)
        return Solution(np.zeros((problem.contacts, 3)), 0, residuals, SOLVED, 0.0, 0.0)
    if sweeps is None:
        sweeps = AUTO_SWEEPS if solver == "auto" else SWEEPS
    return SOLVERS[solver](problem, tolerance, sweeps, start, history)


def _only(problem: ContactProblem, kept: np.ndarray) -> ContactProblem:
    """Return the problem of some of its contacts; the others push nothing."""
    columns = problem.columns
    stays = kept[columns] & kept[problem.row]
    number = np.cumsum(kept) - 1
    counts = np.bincount(number[columns[stays]], minlength=int(kept.sum()))
    return ContactProblem(
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        number[problem.row[stays]],
        problem.blocks[stays],
        *(part[kept] for part in (problem.free, problem.mu, problem.gamma, problem.target)),
    )
