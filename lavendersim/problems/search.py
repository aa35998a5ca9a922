"""A contact problem enters; methods take turns at the best impulses so far, and that leaves.

Sweeps of projected Gauss-Seidel find which contacts open, slide and stick; `semismooth_newton` ends
it in a few steps once most are known, `newton_rounds` get on where neither does, `interior_point`
where sweeps are slow: tall stacks, light below heavy. Each has problems that only it solves.
What is spent is counted (`account`), so equal calls take equal turns.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from lavendersim.engine.contact_problem import NOT_FINITE, SOLVED, SPENT, ContactProblem, Solution
from lavendersim.problems.account import OVERHEAD, Account
from lavendersim.problems.by_kernel import solve_by_kernel
from lavendersim.problems.factorise import ENTRY
from lavendersim.problems.interior_point import BOLD, Way, interior_point
from lavendersim.problems.newton_rounds import newton_rounds
from lavendersim.problems.residual import distances
from lavendersim.problems.scaled_problem import from_impulses, scale, to_impulses
from lavendersim.problems.semismooth_newton import newton_steps

SWEEPER = "projected_gauss_seidel"
# Sweeps before Newton steps cost what so many of those do, within these numbers; twice as many the
# second time, and then something else is tried.
WORTH, FEWEST_SWEEPS, MOST_SWEEPS, OPENING = 20, 100, 2000, 2
# Sweeps between rounds, how often, and how they grow.
LATER_SWEEPS, LATER, GROWTH = 1000, 2, 2
# Price of a sweep per block of W [ns].
SWEEP_PRICE = 6.0
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
        price: float = float("inf"),
    ) -> None:
        self.problem, self.tolerance, self.history = problem, tolerance, history
        self.account = Account(MARGIN * tolerance, steps, price)
        self.best = self.here = np.zeros((problem.contacts, 3)) if start is None else start.copy()
        self.least, _ = distances(problem, self.best)
        self.account.history.append(self.least)
        if not self.over:  # what needs no impulses may have no scale
            self.p = scale(problem)

    @property
    def over(self) -> bool:
        """Whether it is solved or everything is spent."""
        return self.least <= self.account.tolerance or self.account.spent

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
        price = SWEEP_PRICE * len(self.problem.row)
        within = min(sweeps, self.account.steps_left, self.account.price_left / price)
        swept = solve_by_kernel(
            SWEEPER,
            self.problem,
            self.account.tolerance,
            max(1, int(within)),
            self.here,
            self.history,
        )
        told = list(swept.history[1:]) if self.history else []
        self.account.spend(swept.sweeps, price * swept.sweeps, told)
        self.move(swept.impulses, swept.scaled)
        if not self.over:
            x, reached = newton_steps(self.p, from_impulses(self.p, self.here), self.account)
            if reached < swept.scaled:
                self.move(to_impulses(self.p, x), reached)

    def rounds(self) -> None:
        """Make rounds from the best."""
        x, reached = newton_rounds(self.p, from_impulses(self.p, self.best), self.account)
        self.move(to_impulses(self.p, x), reached)

    def interior(self, way: Way = BOLD) -> None:
        """Begin again, from inside the cones."""
        x, reached = interior_point(self.p, self.account, way)
        self.move(to_impulses(self.p, x), reached)

    def open(self) -> None:
        """Sweep and step a few times: most problems end here."""
        blocks = len(self.problem.row)
        step = OVERHEAD + ENTRY * self.problem.blocks.size
        sweeps = int(WORTH * step / (SWEEP_PRICE * blocks))
        sweeps = min(max(sweeps, FEWEST_SWEEPS), MOST_SWEEPS)
        for k in range(OPENING):
            if not self.over:
                self.sweep_and_step(sweeps * 2**k)

    def go_on(self, ways: tuple[Way, ...] = ()) -> None:
        """Take turns until everything is spent, first with an interior point by the ways given."""
        sweeps, left = LATER_SWEEPS, list(ways)
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
        scaled, local = distances(self.problem, self.best)
        status = SPENT if np.isfinite(self.best).all() else NOT_FINITE
        if scaled <= self.tolerance:
            status = SOLVED
        history = np.array(self.account.history if self.history else [])
        return Solution(self.best, self.account.steps, history, status, scaled, local)
