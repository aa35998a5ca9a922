"""The search: its turns, what it may spend, and that the best is kept whatever comes after."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from closed_forms import BY_HAND, cube

from lavendersim.problems import search, solve
from lavendersim.problems.interior_point import STRATEGIES
from lavendersim.problems.scaled_problem import Reached, from_impulses
from lavendersim.problems.search import GROWTH, LATER, LATER_SWEEPS, MARGIN, OPENING, Search


def begun(case: str = "slides", tolerance: float = 1e-9, steps: int = 1000, **given: Any) -> Search:
    return Search(cube(BY_HAND[case][0]), tolerance, steps, None, True, **given)


def test_what_needs_no_impulses_is_over_at_once() -> None:
    assert begun("opens").over
    assert begun("rests as it is").over
    assert not begun("slides").over


def test_it_begins_at_the_given_impulses_and_aims_below_the_tolerance() -> None:
    start = np.ones((4, 3))
    one = Search(cube(BY_HAND["slides"][0]), 1e-6, 10, start, False)
    assert one.best.tolist() == start.tolist()
    assert one.best is not start
    assert one.budget.tolerance == MARGIN * 1e-6


def test_the_best_is_kept_and_the_last_is_gone_on_from() -> None:
    one = begun()
    better, worse = np.full((4, 3), 1.0), np.full((4, 3), 2.0)
    one.move(better, 0.5 * one.least)
    assert one.best is one.here is better
    least = one.least
    one.move(worse, 3.0 * least)
    assert (one.best is better, one.here is worse, one.least) == (True, True, least)
    one.move(np.full((4, 3), np.nan), float("nan"))  # no place to go on from
    assert one.here is worse


def turns_of(one: Search, monkeypatch: pytest.MonkeyPatch, most: int, opening: bool) -> list[Any]:
    taken: list[Any] = []

    def noted(name: str):
        def turn(*given: Any) -> None:
            taken.append((name, *given))
            if len(taken) >= most:
                one.budget.steps_left = 0

        return turn

    for name in ("rounds", "sweep_and_step", "interior"):
        monkeypatch.setattr(one, name, noted(name))
    if opening:
        one.open()
    else:
        one.go_on(STRATEGIES[:2])
    return taken


def test_methods_take_turns_an_interior_point_first_as_long_as_there_are_strategies(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    taken = turns_of(begun(), monkeypatch, 12, opening=False)
    names = [name for name, *_ in taken]
    block = ["interior", "rounds", *["sweep_and_step"] * LATER]
    assert names[:8] == block * 2
    assert names[8:] == [*block[1:], "rounds"]
    assert [given[0] for name, *given in taken if name == "interior"] == list(STRATEGIES[:2])
    sweeps = [given[0] for name, *given in taken if name == "sweep_and_step"]
    grown = [LATER_SWEEPS * GROWTH**k for k in (0, 0, 1, 1, 2, 2)]
    assert sweeps == grown


def test_it_opens_with_sweeps_twice_as_many_each_time(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = turns_of(begun(), monkeypatch, 99, opening=True)
    assert len(taken) == OPENING
    first, second = (given[0] for _, given in zip(range(2), ([n] for _, n in taken), strict=True))
    assert second == 2 * first
    assert search.FEWEST_SWEEPS <= first <= search.MOST_SWEEPS


def test_what_is_solved_takes_no_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    assert turns_of(begun("opens"), monkeypatch, 9, opening=False) == []
    assert turns_of(begun("opens"), monkeypatch, 9, opening=True) == []


@pytest.mark.parametrize("method", ["rounds", "interior"])
def test_a_method_that_solves_it_ends_it(method: str) -> None:
    """By hand: the cube slides on with its velocity less mu times the plane's impulse."""
    one = begun("slides", 1e-9)
    getattr(one, method)()
    assert one.over
    found = one.solution()
    velocity = np.array(BY_HAND["slides"][1])
    total = found.impulses.sum(axis=0)  # along n = z of a cube of 1 kg
    assert total[0] == pytest.approx(velocity[2] - BY_HAND["slides"][0][2], rel=1e-7)
    change = velocity - np.array(BY_HAND["slides"][0])
    assert np.hypot(*total[1:]) == pytest.approx(np.hypot(*change[:2]), rel=1e-7)


def test_the_start_of_rounds_is_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    one, starts = begun(), []

    def rounds(p: Any, x: np.ndarray, budget: Any) -> Reached:
        starts.append(x)
        return Reached(x, one.least)

    monkeypatch.setattr(search, "newton_rounds", rounds)
    best = np.full((4, 3), 0.25)
    one.move(best, 0.5 * one.least)
    one.move(np.zeros((4, 3)), 9.0 * one.least)
    one.rounds()
    np.testing.assert_array_equal(starts[0], from_impulses(one.p, best))


def test_sweeps_alone_take_no_more_than_their_share() -> None:
    one = begun("slides", tolerance=1e-12, cost=1e6)
    before, left = one.least, one.budget.cost_left
    one.sweep_while_it_pays(0.25)
    assert one.least < before
    assert one.budget.steps > 1
    assert left - one.budget.cost_left <= 0.25 * left
    made = one.budget.steps
    one.sweep(3)
    assert one.budget.steps <= made + 3


@pytest.mark.parametrize(("many", "first"), [(4, "sweep_while_it_pays"), (5, "open")])
def test_auto_sweeps_first_where_contacts_are_many(
    many: int, first: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken: list[str] = []
    monkeypatch.setattr(solve, "MANY", many)  # a cube has four
    for name in ("sweep_while_it_pays", "open", "go_on"):
        monkeypatch.setattr(Search, name, lambda *given, name=name: taken.append(name))
    solve.SOLVERS["auto"](cube(BY_HAND["slides"][0]), 1e-9, 100)
    assert taken[0] == first
    assert taken[-2:] == ["open", "go_on"]


@pytest.mark.parametrize(("left", "turns"), [([0.4, 0.15, 0.14], 3), ([0.7], 1), ([0.4] * 9, 2)])
def test_sweeps_are_taken_while_they_pay(
    left: list[float], turns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    search = Search(cube(BY_HAND["slides"][0]), 1e-9, 10**6, None, False, cost=1e12)
    search.least, residuals = 1.0, iter(left)

    def sweep(self: Search, sweeps: float) -> float:
        self.least = next(residuals)
        return self.least

    monkeypatch.setattr(Search, "sweep", sweep)
    search.sweep_while_it_pays(0.8)
    assert len(left) - len(list(residuals)) == turns


def test_sweeps_leave_a_share_of_steps_to_others() -> None:
    search = Search(cube(BY_HAND["slides"][0]), 1e-300, 5, None, False, cost=1e12)
    search.sweep_while_it_pays(0.8)
    assert search.budget.steps_left >= 1
