"""Plain sweeps at first, to the bit; then directions, which end at the same solution."""

from __future__ import annotations

import numpy as np
import pytest
from gauss_seidel import solve_by_gauss_seidel
from matrix_solves import matrix_spec, solve
from problems_in_blocks import random_problem

from lavendersim.engine.solvers.nonsmooth_conjugate_gradient import PLAIN_SWEEPS

SPEC, PLAIN = (
    matrix_spec(name) for name in ("nonsmooth_conjugate_gradient", "projected_gauss_seidel")
)


@pytest.mark.parametrize("sweeps", [1, PLAIN_SWEEPS])
def test_the_first_sweeps_are_those_of_gauss_seidel(sweeps: int, rng) -> None:
    problem = random_problem(rng, 6, coupled=1.0)
    one = solve(problem, SPEC, sweeps=sweeps, tolerance=-1.0)
    other = solve(problem, PLAIN, sweeps=sweeps, tolerance=-1.0)
    np.testing.assert_array_equal(one.impulses, other.impulses)


def test_later_sweeps_differ_and_end_at_the_solution_inside_the_cones(rng) -> None:
    for _ in range(2):
        problem = random_problem(rng, 6, coupled=1.0)
        expected = solve_by_gauss_seidel(problem, 150)
        found = solve(problem, SPEC, sweeps=2000)
        assert found.not_converged == 0
        np.testing.assert_allclose(found.impulses, expected, atol=1e-6)
        some = solve(problem, SPEC, sweeps=PLAIN_SWEEPS + 6, tolerance=-1.0).impulses
        plain = solve(problem, PLAIN, sweeps=PLAIN_SWEEPS + 6, tolerance=-1.0).impulses
        assert not np.array_equal(some, plain)
        assert (np.linalg.norm(some[:, 1:], axis=1) <= problem.mu * some[:, 0] + 1e-14).all()
