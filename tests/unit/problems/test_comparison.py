"""Solvers compared: the clock sees the solver and nothing else, and nobody's word is taken."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pytest
from gauss_seidel import solve_by_gauss_seidel
from made_problems import random_problem

from lavendersim.engine.contact_problem import SOLVED, SPENT, ContactProblem, Solution
from lavendersim.problems import comparison
from lavendersim.problems.comparison import (
    MISSED,
    MOST_REPEATS,
    REACHED,
    compare,
    ratios,
)
from lavendersim.problems.residual import residual

PROBLEM = random_problem(51)
NOTHING = np.zeros((PROBLEM.contacts, 3))
RIGHT = solve_by_gauss_seidel(PROBLEM, 400)


class World:
    """A clock that solvers turn on, and a list of what they were asked."""

    def __init__(self, cost: Callable[[str, int | None, int], float]) -> None:
        self.clock = 0.0
        self.asked: list[tuple] = []
        self._cost = cost

    def now(self) -> float:
        return self.clock

    def answer(self, solver: str, sweeps: int | None) -> Solution:
        return Solution(RIGHT, 12, np.zeros(0), SOLVED, 0.0, 0.0)

    def solve(
        self, problem: ContactProblem, solver: str, tolerance: float, sweeps: int | None
    ) -> Solution:
        earlier = sum(one[0] == solver for one in self.asked)
        self.clock += self._cost(solver, sweeps, earlier)
        self.asked.append((solver, tolerance, sweeps))
        return self.answer(solver, sweeps)

    def compare(self, *solvers: str, curves: bool = False):
        clocks = {"now": self.now, "busy": self.now}
        (found,) = compare(
            [("made", PROBLEM)], solvers, 1e-10, curves=curves, solve=self.solve, **clocks
        )
        return found


def test_compilation_is_kept_apart_from_every_reported_time() -> None:
    world = World(lambda _, __, earlier: 0.02 if earlier else 70.0)
    for attempt in world.compare("fast", "slow", curves=True).attempts:
        assert attempt.first_call == pytest.approx(70.0)
        assert attempt.timing[:3] == pytest.approx((0.02, 0.02, 0.02))
        assert all(point.seconds == pytest.approx(0.02) for point in attempt.points)
        assert attempt.points


def test_the_clock_sees_a_slow_solver() -> None:
    def sleeping(problem, solver, tolerance, sweeps) -> Solution:
        time.sleep(0.05 if solver == "slow" else 0.0)
        return Solution(RIGHT, 1, np.zeros(0), SOLVED, 0.0, 0.0)

    (found,) = compare([("made", PROBLEM)], ["slow", "fast"], 1e-10, solve=sleeping)
    slow, fast = found.attempts
    assert slow.timing.low >= 0.05
    assert fast.timing.median < 0.05


def test_calls_that_others_interrupted_do_not_count_while_there_are_better() -> None:
    def compare_with(interrupted: Callable[[int], bool]):
        world, stolen = World(lambda *_: 1e-3), [0.0]
        solve = world.solve

        def interrupting(*question) -> Solution:
            answer = solve(*question)
            if interrupted(len(world.asked)):
                world.clock += 0.004  # another program has the processor
                stolen[0] += 0.004
            return answer

        (found,) = compare(
            [("made", PROBLEM)], ["one"], 1e-10, solve=interrupting, now=world.now,
            busy=lambda: world.clock - stolen[0],
        )  # fmt: skip
        return found.attempts[0].timing

    seldom = compare_with(lambda call: call % 3 == 0)
    assert seldom.high == pytest.approx(1e-3)
    assert seldom.repeats == MOST_REPEATS
    always = compare_with(lambda call: True)
    assert always.low == pytest.approx(5e-3)


def test_judging_is_not_in_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(lambda *_: 0.01)

    def slow_judge(judge: Callable) -> Callable:
        def judged(*arguments):
            world.clock += 1000.0
            return judge(*arguments)

        return judged

    for name in ("residual", "distances"):
        monkeypatch.setattr(comparison, name, slow_judge(getattr(comparison, name)))
    (attempt,) = world.compare("one", curves=True).attempts
    assert world.clock > 1000.0
    assert attempt.timing.high == pytest.approx(0.01)
    assert max(point.seconds for point in attempt.points) == pytest.approx(0.01)


def test_what_is_cheap_is_repeated_and_what_is_not_is_asked_once() -> None:
    world = World(lambda solver, *_: 1e-3 if solver == "cheap" else 3.0)
    cheap, dear = world.compare("cheap", "dear").attempts
    assert cheap.timing.repeats == MOST_REPEATS
    assert dear.timing.repeats == 1


def test_repeats_of_solvers_take_turns() -> None:
    world = World(lambda *_: 1e-3)
    world.compare("a", "b")
    order = [solver for solver, _, sweeps in world.asked if sweeps is None]
    assert order == ["a", "b"] * MOST_REPEATS


def test_a_solver_that_says_solved_is_not_believed() -> None:
    class Liars(World):
        def answer(self, solver: str, sweeps: int | None) -> Solution:
            if solver == "liar":
                return Solution(NOTHING, 3, np.zeros(0), SOLVED, 1e-12, 1e-12)
            return Solution(RIGHT, 3, np.zeros(0), SPENT, 1.0, 1.0)

    found = Liars(lambda *_: 1.0).compare("liar", "modest")
    liar, modest = found.attempts
    assert (liar.solved, liar.status) == (False, MISSED)
    assert liar.residual == residual(PROBLEM, NOTHING)
    assert (modest.solved, modest.status) == (True, SOLVED)
    assert found.solved
    assert not found._replace(attempts=(liar,)).solved


def test_a_curve_shows_what_was_reached_with_growing_budgets_from_nothing() -> None:
    class Sweeping(World):
        def answer(self, solver: str, sweeps: int | None) -> Solution:
            made = min(sweeps or 100, 20)
            impulses = solve_by_gauss_seidel(PROBLEM, made)
            # It claims little: neither the points nor the verdict may repeat its words.
            return Solution(impulses, made, np.zeros(0), SPENT, 0.5, 0.5)

    world = Sweeping(lambda _, sweeps, __: 0.01 * (sweeps or 100))
    (attempt,) = world.compare("one", curves=True).attempts
    assert [point.budget for point in attempt.points] == [1, 2, 4, 8, 16, 32]
    assert [point.sweeps for point in attempt.points] == [1, 2, 4, 8, 16, 20]
    assert [point.seconds for point in attempt.points] == pytest.approx(
        [0.01, 0.02, 0.04, 0.08, 0.16, 0.32]
    )
    for point in attempt.points:
        reached = residual(PROBLEM, solve_by_gauss_seidel(PROBLEM, point.sweeps))
        assert (point.scaled, point.local) == reached[:2]
    # No tolerance ends a point early but that of round-off.
    assert {one[1] for one in world.asked if one[2] not in (None, 1)} == {REACHED}


def test_a_curve_ends_where_a_call_takes_too_long() -> None:
    class Endless(World):
        def answer(self, solver: str, sweeps: int | None) -> Solution:
            return Solution(NOTHING, sweeps or 100, np.zeros(0), SPENT, 1.0, 1.0)

    world = Endless(lambda _, sweeps, __: 0.3 * (sweeps or 100))
    (attempt,) = world.compare("one", curves=True).attempts
    assert [point.budget for point in attempt.points] == [1, 2, 4, 8]  # 0.3, 0.6, 1.2, 2.4 s


def test_ratios_are_times_over_the_best_that_solved_the_problem() -> None:
    class Some(World):
        def answer(self, solver: str, sweeps: int | None) -> Solution:
            right = RIGHT if solver != "fast but wrong" else NOTHING
            return Solution(right, 1, np.zeros(0), SOLVED, 0.0, 0.0)

    times = {"fast but wrong": 0.5, "good": 2.0, "slow": 6.0}
    world = Some(lambda solver, *_: times[solver])
    first, second = world.compare(*times), world.compare("fast but wrong")
    assert ratios([first]) == {"fast but wrong": [np.inf], "good": [1.0], "slow": [3.0]}
    assert ratios([second]) == {"fast but wrong": [np.inf]}
