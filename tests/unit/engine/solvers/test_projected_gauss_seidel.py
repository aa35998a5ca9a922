"""Sweeps that correct one contact after the other end at the solution, and not a sweep too late."""

from __future__ import annotations

import numpy as np
from gauss_seidel import solve_by_gauss_seidel
from matrix_solves import matrix_spec, solve
from problems_in_blocks import dense, random_problem

from lavendersim.engine.solvers.projected_gauss_seidel import SOLVER, make

SPEC = matrix_spec("projected_gauss_seidel")


def test_impulses_are_those_of_the_slow_twin(rng) -> None:
    """W is positive definite and mu small: one solution. The residual is relative, W some 10."""
    for _ in range(2):
        problem = random_problem(rng, 5)
        found = solve(problem, SPEC)
        assert found.not_converged == 0
        np.testing.assert_allclose(found.impulses, solve_by_gauss_seidel(problem, 150), atol=1e-7)


def test_without_friction_one_contact_is_solved_by_one_sweep(rng) -> None:
    problem = random_problem(rng, 1)._replace(mu=np.zeros(1))
    found = solve(problem, SPEC)
    stiffness = dense(problem)[0, 0] + problem.gamma[0]
    expected = max(-problem.q[0, 0] / stiffness, 0.0)
    np.testing.assert_allclose(found.impulses, [[expected, 0.0, 0.0]], atol=1e-14)
    assert found.sweeps == (1 if expected else 0)


def test_it_stops_at_the_first_sweep_that_reaches_the_tolerance(rng) -> None:
    problem = random_problem(rng, 5, coupled=1.0)
    found = solve(problem, SPEC, tolerance=1e-4)
    assert found.sweeps > 1
    assert found.residual <= 1e-4
    before = solve(problem, SPEC, sweeps=found.sweeps - 1, tolerance=1e-4)
    assert before.not_converged == 1
    assert before.residual > 1e-4


def test_without_a_tolerance_nobody_looks_between_sweeps() -> None:
    assert make(SPEC).residual_every == 1
    assert make(matrix_spec("projected_gauss_seidel", tolerance=False)).residual_every == 0
    assert not SOLVER.contact_fields
