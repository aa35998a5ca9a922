"""Solvers are compared with a reference where there is one, and only there."""

from __future__ import annotations

import numpy as np
import pytest
from closed_forms import BY_HAND, cube
from test_reference import painleve

from lavendersim.engine.contact_problem import SPENT, ContactProblem, Solution
from lavendersim.problems.comparison import compare
from lavendersim.problems.solve import solve

CASE = next(iter(BY_HAND))


def answer(problem: ContactProblem, solver: str, tolerance: float, sweeps: int | None) -> Solution:
    """Solve, or do nothing at all, by name."""
    if solver == "nothing":
        return Solution(np.zeros((problem.contacts, 3)), 1, np.zeros(0), SPENT, 1.0, 1.0)
    return solve(problem, solver, tolerance, sweeps)


def compared(problem: ContactProblem, *solvers: str, referenced: bool = True):
    (found,) = compare(
        [("made", problem)], solvers, 1e-10, solve=answer, curves=True, referenced=referenced
    )
    return found


def test_errors_are_those_of_the_velocities_by_hand() -> None:
    free, after = BY_HAND[CASE]
    found = compared(cube(free), "projected_gauss_seidel", "nothing")
    assert found.truth == "referenced"
    solved, nothing = found.attempts
    # A scaled residual of 1e-10 times the condition of a cube, some tens.
    assert solved.error < 1e-8
    assert solved.points[-1].error < 1e-8
    # Without impulses the cube keeps its velocity; corners see velocities through their axes.
    axes = np.array([cube(velocity).free[0] for velocity in np.eye(3)])
    kept, true = (np.array(velocity) @ axes for velocity in (free, after))
    longest = max(np.linalg.norm(kept), np.linalg.norm(true))
    assert nothing.error == pytest.approx(np.linalg.norm(kept - true) / longest, rel=1e-8)


@pytest.mark.parametrize(
    ("problem", "truth"), [(painleve(), "non-unique"), (cube(BY_HAND[CASE][0]), "")]
)
def test_without_a_single_truth_there_is_no_error(problem: ContactProblem, truth: str) -> None:
    found = compared(problem, "projected_gauss_seidel", referenced=bool(truth))
    assert found.truth == truth
    assert found.reference.startswith(truth)
    assert np.isnan(found.attempts[0].error)
