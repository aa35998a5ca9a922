"""Proximal rounds: a tower from nothing, what slides, exact searches, and a budget."""

from __future__ import annotations

import numpy as np
import pytest
from closed_forms import BY_HAND, cube
from contact_problems import heap, stack

from lavendersim.problems import newton_rounds as rounds
from lavendersim.problems.budget import Budget
from lavendersim.problems.newton_rounds import newton_rounds
from lavendersim.problems.scaled_problem import scale, scaled_residual, velocities


def test_rounds_alone_carry_a_tower_that_rests() -> None:
    """Redundant corners, load from nothing: no sweeps before."""
    p = scale(stack(8, 12, mu=0.6, push=0.0))
    budget = Budget(1e-11, 200)
    x, reached = newton_rounds(p, np.zeros_like(p.b), budget)
    assert reached <= 1e-11
    assert scaled_residual(p, x, velocities(p, x)) == reached


def test_rounds_hold_the_shift_of_what_slides(monkeypatch: pytest.MonkeyPatch) -> None:
    """With no full Newton steps to end it; without the shift a cone would lift what slides.

    Rounds shrink the shift's error by mu or so; they end where round-off is all of G.
    """
    monkeypatch.setattr(rounds, "FINISHING", 0)
    p = scale(cube(BY_HAND["slides"][0]))
    _, reached = newton_rounds(p, np.zeros_like(p.b), Budget(1e-7, 200), 200)
    assert reached <= 1e-7


def test_rounds_stop_when_everything_is_spent() -> None:
    p = scale(heap(0, 10, mu=2.0))
    budget = Budget(1e-14, 4)
    newton_rounds(p, np.zeros_like(p.b), budget)
    assert budget.steps == len(budget.history) <= 4


def test_impulses_that_solve_it_already_are_left_alone() -> None:
    p = scale(cube(BY_HAND["opens"][0]))
    budget = Budget(1e-9, 100)
    x, reached = newton_rounds(p, np.zeros_like(p.b), budget)
    assert not x.any()
    assert reached <= 1e-9
    assert budget.steps == 0


def test_the_slope_of_the_convex_function_grows_along_a_step() -> None:
    """Of a convex function the derivative is monotone; at the length found next to none is left."""
    random = np.random.default_rng(5)
    count = 40
    y, h, centre = random.normal(size=(3, count, 3))
    dh = random.normal(size=(count, 3))
    spread = random.normal(size=(3 * count, 3 * count))
    matrix = spread @ spread.T / count  # symmetric and positive: dy = A dh, as in a round
    y = (matrix @ h.ravel()).reshape(-1, 3) + y
    dy = (matrix @ dh.ravel()).reshape(-1, 3)
    line = rounds.Line(y, h, dy, dh, centre, random.uniform(0.0, 1.0, count), 1e-3)
    slopes = [line.slope(length) for length in np.linspace(-2.0, 2.0, 41)]
    assert np.all(np.diff(slopes) >= -1e-12 * np.abs(slopes).max())


def test_a_search_ends_where_next_to_nothing_of_the_slope_is_left() -> None:
    """One contact pressed by a unit: slope of P(y + l) along e_n is 0 below the cone, then l."""
    up = np.array([[1.0, 0.0, 0.0]])
    none = np.zeros((1, 3))
    for goal in (0.3, 1.0, 5.0, 40.0):
        line = rounds.Line(none, none, up, none, goal * up, np.zeros(1), 0.0)
        assert line.slope(0.0) == -goal
        found = rounds._search(line, line.slope(0.0))
        assert abs(found - goal) <= rounds.SLOPE_LEFT * goal
