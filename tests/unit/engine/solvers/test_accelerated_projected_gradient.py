"""Impulses end where Coulomb's law holds, or at the minimum of the convex relaxation."""

from __future__ import annotations

import numpy as np
import pytest
from gauss_seidel import solve_by_gauss_seidel
from matrix_solves import matrix_spec, projected, solve
from problems_in_blocks import dense, random_problem

SPEC = matrix_spec("accelerated_projected_gradient")


def test_impulses_are_those_of_the_slow_twin(rng) -> None:
    for _ in range(2):
        problem = random_problem(rng, 5)
        found = solve(problem, SPEC, sweeps=3000)
        assert found.not_converged == 0
        np.testing.assert_allclose(found.impulses, solve_by_gauss_seidel(problem, 150), atol=1e-6)


def test_the_relaxation_is_a_minimum_over_the_cones(rng) -> None:
    """At a minimum of r'Wr/2 + q'r a step against its gradient is projected back to where it was.

    No other impulse of the cones has less energy.
    """
    problem = random_problem(rng, 5)
    spec = matrix_spec("accelerated_projected_gradient", friction_cone="convex")
    r = solve(problem, spec, sweeps=3000).impulses
    matrix = dense(problem)
    matrix[::3, ::3] += np.diag(problem.gamma)
    gradient = (matrix @ r.ravel()).reshape(-1, 3) + problem.q
    np.testing.assert_allclose(projected(r - gradient / 10.0, problem.mu), r, atol=1e-7)

    def energy(x):
        return 0.5 * x.ravel() @ matrix @ x.ravel() + np.sum(problem.q * x)

    for _ in range(50):
        other = projected(r + 0.1 * rng.normal(size=r.shape), problem.mu)
        assert energy(other) >= energy(r) - 1e-12


@pytest.mark.parametrize("sweeps", [1, 2, 5, 13])
def test_impulses_are_inside_their_cones_after_every_sweep(sweeps: int, rng) -> None:
    problem = random_problem(rng, 6)
    r = solve(problem, SPEC, sweeps=sweeps, tolerance=-1.0).impulses
    assert (r[:, 0] >= 0.0).all()
    assert (np.linalg.norm(r[:, 1:], axis=1) <= problem.mu * r[:, 0] + 1e-14).all()


def test_a_chain_takes_fewer_sweeps_than_plain_steps_against_the_same_bound(rng) -> None:
    problem = random_problem(rng, 8, coupled=1.0)._replace(mu=np.zeros(8), gamma=np.zeros(8))
    ours = solve(problem, SPEC, sweeps=5000, tolerance=1e-8)
    plain = solve(problem, matrix_spec("jacobi"), sweeps=5000, tolerance=1e-8)
    assert ours.not_converged == 0
    assert ours.sweeps < plain.sweeps
