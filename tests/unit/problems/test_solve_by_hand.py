"""Every solver, alone, on problems whose answer is known by hand; and what none may say."""

from __future__ import annotations

import numpy as np
import pytest
from closed_forms import BY_HAND, MU, cube, laws_broken
from contact_problems import heap
from gauss_seidel import dense
from made_problems import random_problem
from scipy import sparse

from lavendersim.engine.contact_problem import NOT_FINITE, SOLVED
from lavendersim.errors import UsageError
from lavendersim.problems import solve as solving
from lavendersim.problems.matrices import problem_of
from lavendersim.problems.solve import SOLVERS, solve

ALL = sorted(SOLVERS)
ACCURACY = 1e-10  # asked for, of velocities of about 1 m/s
# The natural map is as large as the error of velocities but for the condition of what slides: the
# cube's W has no eigenvalue but 0 below 1/2 of its trace's mean, and mu < 1.
SLACK = 100.0 * ACCURACY


@pytest.mark.parametrize("solver", ALL)
@pytest.mark.parametrize("case", BY_HAND)
def test_a_cube_moves_as_it_does_by_hand(solver: str, case: str) -> None:
    free, after = BY_HAND[case]
    problem = cube(free)
    found = solve(problem, solver, ACCURACY, 20_000)
    assert found.status == SOLVED
    matrix, q = dense(problem)
    u = (matrix @ found.impulses.ravel() + q).reshape(-1, 3)
    # q holds the free velocity in the frame of each contact: turn what is expected the same way.
    seen = np.array([*after]) @ axes_of(problem).T
    np.testing.assert_allclose(u, np.broadcast_to(seen, u.shape), atol=SLACK)


def axes_of(problem) -> np.ndarray:
    """Return the contacts' frame, (3, 3), from what the corners see of unit velocities."""
    columns = [cube(velocity).free[0] for velocity in np.eye(3)]
    return np.array(columns).T


@pytest.mark.parametrize("solver", ALL)
def test_a_solution_obeys_the_laws(solver: str) -> None:
    """A heap that opens, slides and sticks, softness, targets and frictionless contacts."""
    # Power is a product: its share of error counts by its root, 1e-9 of it as 3e-5.
    for problem in (heap(3, 4, corners=1), random_problem(5)):
        found = solve(problem, solver, 1e-9, 100_000)
        assert found.status == SOLVED
        assert laws_broken(problem, found.impulses) < 1e-4


@pytest.mark.parametrize("wrong", ["too much", "turned", "too little friction", "pulls"])
def test_the_laws_tell_what_is_no_solution(wrong: str) -> None:
    problem = cube(BY_HAND["slides"][0])
    r = solve(problem, "interior_point", 1e-10).impulses
    if wrong == "too much":
        r = 1.01 * r
    if wrong == "turned":
        r = r[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
    if wrong == "too little friction":
        r = r * [1.0, 0.99, 0.99]
    if wrong == "pulls":
        r = r - [0.3, 0.0, 0.0]
    assert laws_broken(problem, r) > 1e-3


@pytest.mark.parametrize("solver", ALL)
def test_no_contacts_are_solved(solver: str) -> None:
    nothing = problem_of(sparse.csc_matrix((0, 0)), np.zeros(0), np.zeros(0))
    found = solve(nothing, solver)
    assert (found.status, found.impulses.shape, found.sweeps) == (SOLVED, (0, 3), 0)


@pytest.mark.parametrize("solver", ALL)
def test_contacts_at_rest_get_nothing_whatever_the_start(solver: str) -> None:
    found = solve(cube((0.0, 0.0, 0.0)), solver, start=np.ones((4, 3)))
    assert (found.status, found.sweeps) == (SOLVED, 0)
    assert not found.impulses.any()


@pytest.mark.parametrize("solver", ALL)
def test_separating_contacts_get_exactly_nothing(solver: str) -> None:
    found = solve(cube((0.3, 0.2, 0.5)), solver)
    assert found.status == SOLVED
    assert not found.impulses.any()


@pytest.mark.parametrize("solver", ALL)
def test_a_start_at_the_solution_is_kept(solver: str) -> None:
    problem = cube(BY_HAND["slides"][0])
    there = solve(problem, "interior_point", 1e-12).impulses
    found = solve(problem, solver, 1e-8, start=there)
    assert found.status == SOLVED
    # Kernels sweep once before they look; a sweep from a solution changes nothing but round-off.
    assert found.sweeps <= 1
    np.testing.assert_allclose(found.impulses, there, atol=1e-8)


@pytest.mark.parametrize("solver", ALL)
def test_too_few_sweeps_are_not_a_solution(solver: str) -> None:
    found = solve(heap(0, 10, mu=2.0), solver, 1e-12, 3)
    assert found.status != SOLVED
    assert found.sweeps <= 3
    assert found.scaled > 1e-12


@pytest.mark.parametrize("solver", ALL)
def test_a_contact_between_fixed_bodies_is_refused(solver: str) -> None:
    """Its row of W is empty; one that opens is no hindrance, one that closes has no solution."""
    free = cube(BY_HAND["slides"][0])
    matrix, q = dense(free)
    others = np.delete(np.arange(15), slice(3, 6))
    grown, seen = np.zeros((15, 15)), np.zeros(15)
    grown[np.ix_(others, others)] = matrix
    alone = solve(free, solver)
    for normal, status in ((0.2, SOLVED), (-0.2, "no solution: contact 1 closes at 0.2 m/s")):
        seen[others], seen[3:6] = q, (normal, 1.0, 0.0)
        found = solve(problem_of(sparse.csc_matrix(grown), seen, np.full(5, MU)), solver)
        assert found.status.startswith(status)
        assert not found.impulses[1].any()
        # Judged with a longer |q|, but found on the same four.
        np.testing.assert_array_equal(np.delete(found.impulses, 1, axis=0), alone.impulses)


@pytest.mark.parametrize("solver", ALL)
def test_numbers_that_are_none_are_refused(solver: str) -> None:
    problem = cube((0.0, 0.0, -1.0))
    found = solve(problem._replace(free=np.full((4, 3), np.nan)), solver)
    assert found.status == NOT_FINITE


def test_a_solver_that_lies_is_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    def liar(problem, tolerance, sweeps, start, history):
        found = SOLVERS["projected_gauss_seidel"](problem, tolerance, 1, start, history)
        return found._replace(status=SOLVED, scaled=0.0, local=0.0)

    monkeypatch.setitem(solving.SOLVERS, "liar", liar)
    found = solve(heap(0, 5), "liar", 1e-8)
    assert found.status != SOLVED
    assert found.scaled > 1e-8


def test_an_unknown_solver_is_reported_with_the_nearest() -> None:
    with pytest.raises(UsageError, match='did you mean "semismooth_newton"'):
        solve(cube((0.0, 0.0, -1.0)), "semismoth_newton")


def test_every_kernel_has_its_place() -> None:
    """Other than the one that adapts to a scene's bodies."""
    assert set(solving.KERNELS) - set(SOLVERS) == {"adaptive"}
