"""All contacts look at once and act at once: no order counts, and no step overshoots."""

from __future__ import annotations

import numpy as np
from contact_problems import renumbered
from gauss_seidel import solve_by_gauss_seidel
from matrix_solves import matrix_spec, projected, solve
from problems_in_blocks import dense, random_problem

from lavendersim.engine.matrix_problem import contacts_of

SPEC = matrix_spec("jacobi")


def test_the_first_sweep_projects_a_step_against_the_bound(rng) -> None:
    """From nothing: r_n = max(0, -q_n/c), and friction -q_t/c, cut to the disc of mu r_n."""
    problem = random_problem(rng, 6)
    found = solve(problem, SPEC, sweeps=1, tolerance=-1.0).impulses
    bound = contacts_of(problem, SPEC, np.zeros((6, 3)))["bound"]
    step = -problem.q / bound[:, None]
    normal = np.maximum(step[:, 0], 0.0)
    length = np.linalg.norm(step[:, 1:], axis=1)
    friction = step[:, 1:] * np.minimum(1.0, problem.mu * normal / length)[:, None]
    np.testing.assert_allclose(found, np.column_stack([normal, friction]), atol=1e-14)


def test_the_convex_relaxation_projects_onto_the_cone(rng) -> None:
    problem = random_problem(rng, 6)
    spec = matrix_spec("jacobi", friction_cone="convex")
    found = solve(problem, spec, sweeps=1, tolerance=-1.0).impulses
    bound = contacts_of(problem, spec, np.zeros((6, 3)))["bound"]
    np.testing.assert_allclose(
        found, projected(-problem.q / bound[:, None], problem.mu), atol=1e-14
    )


def test_no_order_of_the_contacts_counts(rng) -> None:
    problem = random_problem(rng, 6)
    order = np.random.default_rng(3).permutation(6)  # as `renumbered` draws it
    one = solve(problem, SPEC, sweeps=7, tolerance=-1.0).impulses
    other = solve(renumbered(problem, 3), SPEC, sweeps=7, tolerance=-1.0).impulses
    np.testing.assert_allclose(other, one[order], atol=1e-13)


def test_it_ends_at_the_solution_and_the_energy_of_a_frictionless_one_never_rises(rng) -> None:
    problem = random_problem(rng, 4)
    found = solve(problem, SPEC, sweeps=3000)
    assert found.not_converged == 0
    np.testing.assert_allclose(found.impulses, solve_by_gauss_seidel(problem, 150), atol=1e-6)
    frictionless = problem._replace(mu=np.zeros(4))
    matrix, energies = dense(frictionless), []
    matrix[::3, ::3] += np.diag(frictionless.gamma)
    for sweeps in range(1, 12):
        r = solve(frictionless, SPEC, sweeps=sweeps, tolerance=-1.0).impulses.ravel()
        energies.append(0.5 * r @ matrix @ r + frictionless.q.ravel() @ r)
    assert (np.diff(energies) <= 1e-13).all()
