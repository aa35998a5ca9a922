"""A search by several methods that take turns at the best impulses so far.

Sweeps of projected Gauss-Seidel find which contacts open, slide and stick; `semismooth_newton` ends
it in a few steps once most are known, `newton_rounds` get on where neither does, `interior_point`
where sweeps are slow: tall stacks, light below heavy. Each has problems that only it solves.
What is spent is counted (`budget`), so equal calls take equal turns.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from lavendersim.engine.contact_problem import ContactProblem, Solution
from lavendersim.problems.budget import STEP_OVERHEAD, Budget
from lavendersim.problems.by_kernel import solve_by_kernel
from lavendersim.problems.factorise import ENTRY
from lavendersim.problems.interior_point import LONG_STEPS, Strategy, interior_point
from lavendersim.problems.newton_rounds import newton_rounds
from lavendersim.problems.residual import distances, judged
from lavendersim.problems.scaled_problem import from_impulses, scale, to_impulses
from lavendersim.problems.semismooth_newton import newton_steps

SWEEPER = "projected_gauss_seidel"
# Sweeps before Newton steps cost what so many of those do, within these numbers; twice as many the
# second time, and then something else is tried.
WORTH, FEWEST_SWEEPS, MOST_SWEEPS, OPENING = 20, 100, 2000, 2
# Sweeps between rounds, how often, and how they grow.
LATER_SWEEPS, LATER, GROWTH = 1000, 2, 2
# Cost of a sweep per block of W [ns].
SWEEP_COST = 6.0
# Where contacts are many: so many sweeps at a time, as long as they leave no more than this share.
TURN_OF_SWEEPS, PAYS = 10_000, 0.5
# A method aims below the tolerance by this: the judge rounds otherwise [-].
MARGIN = 0.5


class Search:
    """The best impulses so far, and what the methods may still spend."""

    def __init__(
        self,
        problem: ContactProblem,
        tolerance: float,
        steps: int,
        start: np.ndarray | None,
        history: bool,
        cost: float = float("inf"),
    ) -> None:
        self.problem, self.tolerance, self.history = problem, tolerance, history
        self.budget = Budget(MARGIN * tolerance, steps, cost)
        self.best = self.here = np.zeros((problem.contacts, 3)) if start is None else start.copy()
        self.least = distances(problem, self.best).scaled
        self.budget.history.append(self.least)
        if not self.over:  # what needs no impulses may have no scale
            self.p = scale(problem)

    @property
    def over(self) -> bool:
        """Whether it is solved or everything is spent."""
        return self.least <= self.budget.tolerance or self.budget.spent

    def move(self, impulses: np.ndarray, reached: float) -> None:
        """Go on from these impulses; remember them where they are the best."""
        if np.isfinite(reached):
            self.here = impulses
        if reached < self.least:
            self.best, self.least = impulses, reached

    def sweep_and_step(self, sweeps: int) -> None:
        """Sweep from here, then Newton; where that is no better, go on from the sweeps' end.

        Not from the best: that would end where it did before.
        """
        reached_before = self.sweep(sweeps)
        if not self.over:
            x, reached = newton_steps(self.p, from_impulses(self.p, self.here), self.budget)
            if reached < reached_before:
                self.move(to_impulses(self.p, x), reached)

    def sweep(self, sweeps: float) -> float:
        """Sweep from here; return the residual."""
        cost = SWEEP_COST * len(self.problem.row)
        within = min(sweeps, self.budget.steps_left, self.budget.cost_left / cost)
        swept = solve_by_kernel(
            SWEEPER,
            self.problem,
            self.budget.tolerance,
            max(1, int(within)),
            self.here,
            self.history,
        )
        residuals = list(swept.history[1:]) if self.history else []
        self.budget.spend(swept.sweeps, cost * swept.sweeps, residuals)
        self.move(swept.impulses, swept.scaled)
        return swept.scaled

    def sweep_while_it_pays(self, share: float) -> None:
        """Sweep from here until so much is spent [-], or what is left falls too slowly."""
        cost = SWEEP_COST * len(self.problem.row)
        steps, spent = (1.0 - share) * self.budget.steps_left, (1.0 - share) * self.budget.cost_left
        falls = True
        while falls and not self.over:
            within = min(self.budget.steps_left - steps, (self.budget.cost_left - spent) / cost)
            if within < 1.0:
                break
            before = self.least
            falls = self.sweep(min(TURN_OF_SWEEPS, within)) <= PAYS * before

    def rounds(self) -> None:
        """Make rounds from the best."""
        x, reached = newton_rounds(self.p, from_impulses(self.p, self.best), self.budget)
        self.move(to_impulses(self.p, x), reached)

    def interior(self, strategy: Strategy = LONG_STEPS) -> None:
        """Begin again, from inside the cones."""
        x, reached = interior_point(self.p, self.budget, strategy)
        self.move(to_impulses(self.p, x), reached)

    def open(self) -> None:
        """Sweep and step a few times: most problems end here."""
        blocks = len(self.problem.row)
        step = STEP_OVERHEAD + ENTRY * self.problem.blocks.size
        sweeps = int(WORTH * step / (SWEEP_COST * blocks))
        sweeps = min(max(sweeps, FEWEST_SWEEPS), MOST_SWEEPS)
        for k in range(OPENING):
            if not self.over:
                self.sweep_and_step(sweeps * 2**k)

    def go_on(self, strategies: tuple[Strategy, ...] = ()) -> None:
        """Take turns until everything is spent, the first ones with an interior point each."""
        sweeps, left = LATER_SWEEPS, list(strategies)
        while not self.over:
            turns: list[Callable[[], None]] = [self.rounds]
            turns += [partial(self.sweep_and_step, sweeps)] * LATER
            if left:
                turns.insert(0, partial(self.interior, left.pop(0)))
            for turn in turns:
                if not self.over:
                    turn()
            sweeps *= GROWTH

    def solution(self) -> Solution:
        """Return the best, judged from its impulses alone."""
        history = np.array(self.budget.history if self.history else [])
        return judged(self.problem, self.best, self.tolerance, self.budget.steps, history)
