"""The comparison of solvers on contact problems: residual, error and time of each.

A solver's own status does not count: a problem is solved where `residual` of the returned impulses
is below the tolerance. Time is that of a whole call, from the problem to its solution, on the wall;
compilation is in the first call, which is reported apart. The residual is computed after the clock
has stopped. Calls that other programs interrupted, as the processor's own time shows, count only
where all are.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from statistics import median
from typing import TYPE_CHECKING, NamedTuple

from lavendersim.engine.contact_problem import SOLVED, ContactProblem, Solution
from lavendersim.problems.residual import Residual, contact_velocities, distances, residual

if TYPE_CHECKING:
    from lavendersim.problems.reference import Reference

Solve = Callable[..., Solution]
Clock = Callable[[], float]

MISSED = "tolerance missed"  # by the solver solved, by the residual not
# A call is repeated while that is cheap. Repeats of all calls on a problem take turns: what slows
# the machine for a while slows every solver.
MOST_REPEATS = 9
MOST_CALLS = 3 * MOST_REPEATS  # with those that were interrupted
UNDISTURBED = 0.9  # of its wall time the process had the processor, in all its threads
FINE = 1e-6  # [s] resolution of a clock of the processor that can tell
REPEATING = 0.8  # [s] of all repeats of a call that is reported
REPEATING_STEP = 0.2  # [s] and of one on a curve, where there are many
# The curve of a solver: calls with 1, 2, 4, ... sweeps, each from nothing.
REACHED = 1e-13  # scaled residual that ends a curve; beyond is round-off
LONGEST_CALL = 2.0  # [s] a call that took longer ends its curve
MOST_DOUBLINGS = 20


class Timing(NamedTuple):
    """The time of a call [s]."""

    median: float
    low: float
    high: float
    repeats: int


class Point(NamedTuple):
    """What a solver reaches from nothing with so many sweeps."""

    budget: int  # sweeps allowed
    sweeps: int  # sweeps made
    seconds: float  # median [s]
    repeats: int
    scaled: float  # residual [-]
    local: float
    error: float  # of the velocities against the reference, relative [-]; NaN where there is none


class Attempt(NamedTuple):
    """What a solver made of a problem."""

    solver: str
    solved: bool  # by the residual
    status: str
    residual: Residual
    error: float  # of the velocities against the reference, relative [-]; NaN where there is none
    sweeps: int
    timing: Timing
    first_call: float  # [s], with compilation where there is some
    points: tuple[Point, ...]


class SolverComparison(NamedTuple):
    """One problem and what each solver made of it."""

    name: str
    contacts: int
    attempts: tuple[Attempt, ...]
    reference: str = ""  # one sentence: how sure the reference is; empty where none was computed
    truth: str = ""  # its kind

    @property
    def solved(self) -> bool:
        """Whether any solver did."""
        return any(attempt.solved for attempt in self.attempts)


class _Asked(NamedTuple):
    """What is asked of every problem."""

    solvers: Sequence[str]
    tolerance: float
    sweeps: int | None
    curves: bool


def compare(
    problems: Iterable[tuple[str, ContactProblem]],
    solvers: Sequence[str],
    tolerance: float,
    sweeps: int | None = None,
    *,
    curves: bool = False,
    solve: Solve | None = None,
    now: Clock = time.perf_counter,
    busy: Clock = time.process_time,
    referenced: bool = False,
) -> Iterator[SolverComparison]:
    """Yield a comparison per named problem, as soon as it is there.

    `solve(problem, solver, tolerance, sweeps)` is `problems.solve.solve` unless another is given;
    referenced: hold velocities against those of `reference`, where it knows what is true.
    """
    asked = _Asked(solvers, tolerance, sweeps, curves)
    call = solve or _solve()
    if busy is time.process_time and time.get_clock_info("process_time").resolution > FINE:
        busy = now  # a clock of ticks cannot tell: no call passes for interrupted
    for name, problem in problems:
        watch = _Stopwatch(call, now, busy)
        truth = _reference(problem) if referenced else None
        yield _compare(name, problem, asked, watch, truth)


def _solve() -> Solve:
    from lavendersim.problems.solve import solve  # late: brings numba

    return solve


def _reference(problem: ContactProblem) -> Reference:
    from lavendersim.problems.reference import reference

    return reference(problem)


def _error(truth: Reference | None, problem: ContactProblem, solution: Solution) -> float:
    """Return the relative error of the velocities; NaN where nothing is known to be true."""
    if truth is None or truth.kind != "referenced":
        return float("nan")
    from lavendersim.problems.reference import relative_difference

    return relative_difference(
        problem, contact_velocities(problem, solution.impulses), truth.velocities
    )


class _Call:
    """The arguments of repeated calls of a solver, their last solution and the times of all."""

    def __init__(
        self,
        problem: ContactProblem,
        solver: str,
        tolerance: float,
        sweeps: int | None,
        repeating: float = REPEATING,
    ) -> None:
        self.arguments = (problem, solver, tolerance, sweeps)
        self._repeating = repeating  # [s]
        self.times: list[float] = []  # of all calls
        self.undisturbed: list[float] = []  # of those that nothing interrupted
        self.solution: Solution

    @property
    def is_cheap(self) -> bool:
        """Whether to call again: rarely what takes long."""
        enough = len(self.undisturbed) >= MOST_REPEATS or len(self.times) >= MOST_CALLS
        return not enough and sum(self.times) + self.times[0] < self._repeating

    @property
    def timing(self) -> Timing:
        times = self.undisturbed or self.times
        return Timing(median(times), min(times), max(times), len(times))


class _Stopwatch(NamedTuple):
    """Calls a solver between two readings of the clocks."""

    solve: Solve
    now: Clock
    busy: Clock

    def time(self, call: _Call) -> None:
        begin, begin_busy = self.now(), self.busy()
        call.solution = self.solve(*call.arguments)
        seconds, busy = self.now() - begin, self.busy() - begin_busy
        call.times.append(seconds)
        if busy >= UNDISTURBED * seconds:
            call.undisturbed.append(seconds)


def _compare(
    name: str,
    problem: ContactProblem,
    asked: _Asked,
    watch: _Stopwatch,
    truth: Reference | None,
) -> SolverComparison:
    """Call each solver once to compile it, then timed, then again in turns."""
    solvers, tolerance = asked.solvers, asked.tolerance
    first = {solver: _Call(problem, solver, tolerance, 1) for solver in solvers}
    whole = {solver: _Call(problem, solver, tolerance, asked.sweeps) for solver in solvers}
    for call in (*first.values(), *whole.values()):
        watch.time(call)
    steps = {solver: _steps(problem, solver, watch) if asked.curves else [] for solver in solvers}
    calls = [*whole.values(), *(call for each in steps.values() for call in each)]
    while cheap := [call for call in calls if call.is_cheap]:
        for call in cheap:
            watch.time(call)
    attempts = (
        _judge(
            whole[solver],
            first[solver].times[0],
            [_point(step, truth) for step in steps[solver]],
            truth,
        )
        for solver in solvers
    )
    status = ("", "") if truth is None else (truth.status, truth.kind)
    return SolverComparison(name, problem.contacts, tuple(attempts), *status)


def _steps(problem: ContactProblem, solver: str, watch: _Stopwatch) -> list[_Call]:
    """Call with twice as many sweeps each time, until more of them would be of no use."""
    calls = []
    for doubling in range(MOST_DOUBLINGS + 1):
        calls.append(_Call(problem, solver, REACHED, 2**doubling, REPEATING_STEP))
        watch.time(calls[-1])
        solution = calls[-1].solution
        scaled = distances(problem, solution.impulses).scaled
        if solution.sweeps < 2**doubling or scaled <= REACHED or calls[-1].times[0] > LONGEST_CALL:
            break
    return calls


def _point(call: _Call, truth: Reference | None) -> Point:
    problem, _, _, budget = call.arguments
    reached = distances(problem, call.solution.impulses)
    error = _error(truth, problem, call.solution)
    timing = call.timing
    return Point(budget or 0, call.solution.sweeps, timing.median, timing.repeats, *reached, error)


def _judge(
    call: _Call, first_call: float, points: Sequence[Point], truth: Reference | None
) -> Attempt:
    problem, solver, tolerance, _ = call.arguments
    solution = call.solution
    judged = residual(problem, solution.impulses)
    solved = judged.scaled <= tolerance
    status = SOLVED if solved else solution.status
    if not solved and status == SOLVED:
        status = MISSED
    return Attempt(
        solver,
        solved,
        status,
        judged,
        _error(truth, problem, solution),
        solution.sweeps,
        call.timing,
        first_call,
        tuple(points),
    )


def ratios(comparisons: Sequence[SolverComparison]) -> dict[str, list[float]]:
    """Return per solver its time over the best time, per problem; infinite where not solved.

    What performance profiles are made of (Dolan and More, 2002). A problem that nobody solved
    counts as not solved for everybody.
    """
    found: dict[str, list[float]] = {}
    for comparison in comparisons:
        times = {
            one.solver: one.timing.median if one.solved else float("inf")
            for one in comparison.attempts
        }
        best = min(times.values(), default=float("inf"))
        for solver, seconds in times.items():
            ratio = seconds / best if best < float("inf") else float("inf")
            found.setdefault(solver, []).append(ratio)
    return found
