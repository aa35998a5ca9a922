"""References: right where the answer is known, and silent where there is none or more than one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from closed_forms import BY_HAND, cube
from contact_problems import heap, in_units, wedge
from gauss_seidel import dense
from made_problems import FOLDER, needs_outside, outside
from scipy import sparse

from lavendersim.problems.matrices import problem_of
from lavendersim.problems.read import read_problem
from lavendersim.problems.reference import (
    AGREEMENT,
    NON_UNIQUE,
    REFERENCED,
    TOLERANCE,
    UNREFERENCED,
    reference,
    relative_difference,
)
from lavendersim.problems.residual import residual


@pytest.mark.parametrize("case", BY_HAND)
def test_a_cube_on_a_plane_is_referenced(case: str) -> None:
    """Its corners share what they carry as they like; its velocities are those by hand."""
    free, after = BY_HAND[case]
    problem = cube(free)
    found = reference(problem)
    assert found.kind == REFERENCED
    axes = np.array([cube(velocity).free[0] for velocity in np.eye(3)])
    seen = np.broadcast_to(np.array(after) @ axes, (4, 3))
    # Of free velocities of some m/s; the condition of a cube is some tens.
    np.testing.assert_allclose(found.velocities, seen, atol=1e-8)


def painleve():
    """A contact that may open or jam, mu W_nt > W_nn: by hand r = 0, or r_n = 1 and it slides.

    u_n = r_n + 1.5 r_t + 0.5,  u_t = 1.5 r_n + 4 r_t + 4,  mu = 1. With r_t = -r_n:
    u_n = 0 at r_n = 1 where u_t = 1.5 slides on; and r = 0 opens at 0.5.
    """
    matrix = np.array([[1.0, 1.5, 0.0], [1.5, 4.0, 0.0], [0.0, 0.0, 4.0]])
    return problem_of(sparse.csc_matrix(matrix), np.array([0.5, 4.0, 0.0]), np.ones(1))


def test_two_solutions_are_distinguished() -> None:
    problem = painleve()
    for by_hand in ([0.0, 0.0, 0.0], [1.0, -1.0, 0.0]):
        assert residual(problem, np.array([by_hand])).scaled < 1e-15
    found = reference(problem)
    assert found.kind == NON_UNIQUE
    # (0.5, 4) and (0, 1.5), over |q| = |(0.5, 4)|.
    assert found.difference == pytest.approx(np.hypot(0.5, 2.5) / np.hypot(0.5, 4.0), rel=1e-8)
    assert "non-unique" in found.status


def test_a_problem_without_solution_is_unreferenced() -> None:
    """A cube between two walls is to leave both."""
    between = wedge(0, 1, 0.3)
    found = reference(between._replace(target=np.full(between.contacts, -1.0)))
    assert found.kind == UNREFERENCED
    for solver, solution in found.solutions.items():
        assert solution.scaled > TOLERANCE
        assert f"{solver} reached" in found.status


def test_a_reference_is_the_same_in_other_units() -> None:
    problem = heap(4, 5, corners=1)
    mass, velocity = 1e3, 2.2369362921
    plain, copy = reference(problem), reference(in_units(problem, mass, velocity))
    assert plain.kind == copy.kind == REFERENCED
    assert relative_difference(problem, copy.velocities / velocity, plain.velocities) < AGREEMENT


def test_the_velocities_are_those_of_the_best_solution() -> None:
    problem = heap(5, 6, corners=1)
    found = reference(problem)
    best = min(found.solutions.values(), key=lambda solution: solution.scaled)
    matrix, q = dense(problem)
    u = (matrix @ best.impulses.ravel() + q).reshape(-1, 3)
    np.testing.assert_allclose(found.velocities, u, atol=1e-12 * np.abs(u).max())


@outside
def test_problems_of_others_are_referenced_but_for_one(file: Path) -> None:
    found = reference(read_problem(file))
    assert found.kind == (NON_UNIQUE if "OneObject" in file.name else REFERENCED), found.status
    reached = [s for s in found.solutions.values() if s.scaled <= TOLERANCE]
    assert len(reached) >= 2


@needs_outside
def test_the_one_has_solutions_whose_velocities_are_two_per_cent_apart() -> None:
    """As its collectors tell: 1.7 %."""
    (file,) = Path(FOLDER).glob("OneObject*")
    assert reference(read_problem(file)).difference == pytest.approx(0.017, abs=0.001)
