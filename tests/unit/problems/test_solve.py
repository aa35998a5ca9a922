"""`auto` solves what is hard, what others wrote, and the same written down otherwise."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from contact_problems import HARD, heap, in_units, renumbered, turned, wedge
from made_problems import outside

from lavendersim.engine.contact_problem import SOLVED, SPENT, ContactProblem
from lavendersim.problems.read import read_problem
from lavendersim.problems.residual import residual
from lavendersim.problems.solve import SOLVERS, solve

TOLERANCE = 1e-8
LONGEST = 5.0  # [s]
SAME = {
    "renumbered": lambda problem: renumbered(problem, 5),
    "turned": lambda problem: turned(problem, 6),
    # Not powers of two: every number of the copy is rounded otherwise.
    "in grams and miles per hour": lambda problem: in_units(problem, 1e3, 2.2369362921),
    "in tonnes and millimetres": lambda problem: in_units(problem, 1e-3, 1e3),
}


def is_solved(problem: ContactProblem) -> bool:
    found = solve(problem, "auto", TOLERANCE)
    assert (found.status == SOLVED) == (residual(problem, found.impulses).scaled <= TOLERANCE)
    return found.status == SOLVED


@pytest.mark.parametrize("name", HARD)
def test_hard_problems_are_solved(name: str) -> None:
    assert is_solved(HARD[name]())


@pytest.mark.parametrize("way", SAME)
@pytest.mark.parametrize("name", ["a tower of 12", "light below heavy", "a heap", "wedged"])
def test_a_hard_problem_is_solved_however_it_is_written(name: str, way: str) -> None:
    assert is_solved(SAME[way](HARD[name]()))


@outside
def test_problems_of_others_are_solved_within_five_seconds(file: Path) -> None:
    problem = read_problem(file)
    solve(problem, "auto", 1.0)  # compiles
    times = []
    while not times or (min(times) > LONGEST and len(times) < 3):
        begun = time.thread_time()
        found = solve(problem, "auto", TOLERANCE)
        times.append(time.thread_time() - begun)
    assert residual(problem, found.impulses).scaled <= TOLERANCE
    assert found.status == SOLVED
    assert min(times) < LONGEST


@outside
@pytest.mark.parametrize("way", SAME)
def test_copies_of_problems_of_others_are_solved(file: Path, way: str) -> None:
    assert is_solved(SAME[way](read_problem(file)))


@outside
@pytest.mark.parametrize("solver", sorted(SOLVERS))
def test_nothing_of_others_is_called_solved_that_is_not(file: Path, solver: str) -> None:
    problem = read_problem(file)
    for sweeps in (1, 30, 300):
        found = solve(problem, solver, TOLERANCE, sweeps)
        assert found.sweeps <= sweeps
        judged = residual(problem, found.impulses)
        assert (found.scaled, found.local) == (judged.scaled, judged.local)
        assert (found.status == SOLVED) == (judged.scaled <= TOLERANCE)


def test_equal_calls_give_equal_bits() -> None:
    """What may be spent is counted, not timed."""
    problem = heap(1, 12, ratio=1e3)
    first, second = (solve(problem, "auto", 1e-10) for _ in range(2))
    assert first.sweeps == second.sweeps
    assert first.impulses.tobytes() == second.impulses.tobytes()


def test_an_impossible_problem_is_given_up_at_its_cost() -> None:
    """A cube between two walls is to leave both at 1 m/s: no motion does that."""
    between = wedge(0, 1, 0.3)
    problem = between._replace(target=np.full(between.contacts, -1.0))
    begun = time.thread_time()
    found = solve(problem, "auto", TOLERANCE)
    assert time.thread_time() - begun < 2.0 * LONGEST
    assert found.status == SPENT
    assert np.isfinite(found.impulses).all()


def test_the_history_falls_to_what_is_reached() -> None:
    problem = heap(2, 8)
    for solver in ("auto", "semismooth_newton", "interior_point"):
        found = solve(problem, solver, TOLERANCE, history=True)
        assert len(found.history) == found.sweeps + 1
        # At the start there are no impulses, and the natural map is what closes.
        assert found.history[0] == pytest.approx(residual(problem, 0 * found.impulses).scaled)
        assert found.history.min() <= found.history[0]
        assert found.scaled <= TOLERANCE
