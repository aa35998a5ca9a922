"""A solver does the same to a problem whether impulses act on bodies or through the matrix W.

The engine solves a step over its bodies, cold; the assembled problem of the same step is then
solved by the same solver through W, which shares no line with the way over bodies.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from laboratory import Bench, box, plane, planned, resolved
from made_problems import random_problem

from lavendersim.engine.assemble import StepProblem
from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.engine.matrix_problem import contacts_of
from lavendersim.problems.by_kernel import solve_by_kernel, spec_of
from lavendersim.problems.matrices import matrix_of
from lavendersim.problems.residual import contact_velocities, residual

GRAVITY = (0.0, 0.0, -9.81)
# One box lands tilted and sliding on a soft floor: four contacts that stick, slide and open. Fewer
# than eight contacts are swept in the order of their rows, as through W.
BODIES: dict[str, Any] = {
    "floor": plane(friction=0.4, compliance=1e-5),
    "box": box(
        (1.0, 0.6, 0.4),
        (0.0, 0.0, 0.199),
        mass=3.0,
        friction=0.4,
        velocity=(0.8, -0.3, -1.0),
        angular_velocity=(0.5, -0.7, 0.2),
    ),
}
SWEPT_ALIKE = ["projected_gauss_seidel", "nonsmooth_conjugate_gradient"]
# Steps of these follow a bound on W, which is tighter through the matrix: other sweeps, same end.
STEPPED = ["jacobi", "accelerated_projected_gradient"]
# Impulses of some N s after a few hundred products of numbers of order 1 and 10, each rounded by
# 1e-16.
ROUND_OFF = 1e-12


def stepped(solver: str, sweeps: int) -> Bench:
    """Return an engine after its first step, solved by so many sweeps."""
    cell = resolved(BODIES, GRAVITY, sweeps=sweeps, solver=solver, tolerance=1e-14)
    cell["record"]["problems"] = "every 1"
    bench = Bench(cell, planned(cell).spec)
    bench.run(1)
    return bench


def solved(solver: str, sweeps: int) -> StepProblem:
    """Return the problem of the first step, and the engine's impulses after so many sweeps."""
    bench = stepped(solver, sweeps)
    found = bench.engine.problem()
    assert found is not None
    assert found.problem.contacts == 4
    return found


@pytest.mark.parametrize("sweeps", [1, 3, 12])
@pytest.mark.parametrize("solver", SWEPT_ALIKE)
def test_sweeps_over_bodies_and_through_the_matrix_leave_the_same_impulses(
    solver: str, sweeps: int
) -> None:
    problem, impulses = solved(solver, sweeps)
    found = solve_by_kernel(solver, problem, tolerance=-1.0, sweeps=sweeps)
    assert found.sweeps == sweeps
    assert np.abs(impulses).max() > 0.1
    np.testing.assert_allclose(found.impulses, impulses, rtol=0, atol=ROUND_OFF)


@pytest.mark.parametrize("solver", STEPPED)
def test_steps_over_bodies_and_through_the_matrix_end_at_the_same_velocities(solver: str) -> None:
    problem, impulses = solved(solver, 5000)
    found = solve_by_kernel(solver, problem, tolerance=1e-13, sweeps=5000)
    assert found.scaled <= 1e-13
    # The engine stops at a residual of 1e-14 m/s, here at 1e-13 of |q|, some m/s: both are off by
    # that times the condition of W on a box, below 1e3.
    one, other = (contact_velocities(problem, each) for each in (impulses, found.impulses))
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)


@pytest.mark.parametrize("solver", [*SWEPT_ALIKE, *STEPPED])
def test_the_history_a_kernel_keeps_is_the_residual_of_its_impulses(solver: str) -> None:
    problem, _ = solved("projected_gauss_seidel", 1)
    for sweeps in (0, 1, 7):
        found = solve_by_kernel(solver, problem, -1.0, sweeps, history=True)
        assert len(found.history) == found.sweeps + 1
        judged = residual(problem, found.impulses).scaled
        np.testing.assert_allclose(found.history[-1], judged, rtol=1e-9, atol=ROUND_OFF)


def least_room(problem: ContactProblem, bound: np.ndarray) -> float:
    """Return the least eigenvalue of the diagonal matrix of `bound` less W, over the largest."""
    matrix = matrix_of(problem).toarray() + np.diag(np.kron(problem.gamma, [1.0, 0.0, 0.0]))
    left = np.diag(np.repeat(bound, 3)) - 0.5 * (matrix + matrix.T)
    return float(np.linalg.eigvalsh(left).min() / bound.max())


# W is at most the diagonal matrix of `bound`: the difference has no negative eigenvalue. Those of
# matrices of this size are good to 1e-15 of the norm.
@pytest.mark.parametrize("seed", range(8))
def test_no_step_through_the_matrix_can_overshoot(seed: int) -> None:
    problem = random_problem(seed, contacts=6)
    zeros = np.zeros((problem.contacts, 3))
    bound = contacts_of(problem, spec_of("jacobi"), zeros)["bound"]
    assert least_room(problem, bound) >= -1e-13


def test_no_step_over_bodies_can_overshoot() -> None:
    bench = stepped("jacobi", 1)
    found = bench.engine.problem()
    assert found is not None
    assert least_room(found.problem, bench.engine.contacts["bound"][:4]) >= -1e-13
