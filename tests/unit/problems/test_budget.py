"""A budget counts steps and nominal costs, and ends with whichever is spent first."""

from __future__ import annotations

from lavendersim.problems.budget import STEP_OVERHEAD, Budget


def test_it_is_spent_with_its_steps() -> None:
    budget = Budget(1e-9, steps=3)
    budget.spend(2, 1e6, [0.5, 0.25])
    assert not budget.spent
    budget.step(0.0, 0.125)
    assert budget.spent
    assert (budget.steps, budget.history) == (3, [0.5, 0.25, 0.125])


def test_it_is_spent_with_its_cost() -> None:
    budget = Budget(1e-9, steps=1000, cost=2.0 * STEP_OVERHEAD + 10.0)
    budget.step(5.0, 1.0)
    assert not budget.spent
    budget.step(5.0, 1.0)  # exactly all of it
    assert budget.spent
