"""The residual that judges solvers: zero at solutions, and what it must be away from them."""

from __future__ import annotations

import numpy as np
import pytest
from gauss_seidel import solve_by_gauss_seidel
from made_problems import random_problem
from scipy import sparse

from lavendersim.problems.matrices import problem_of
from lavendersim.problems.residual import distances, residual

EPS = np.finfo(float).eps


def one_contact(q, mu: float = 0.5, gamma: float = 0.0, target: float = 0.0):
    """Return a contact of a unit mass: W is the identity."""
    problem = problem_of(sparse.eye(3, format="csc"), np.array(q, dtype=float), np.array([mu]))
    return problem._replace(gamma=np.array([gamma]), target=np.array([target]))


# By hand, with W = 1: what opens needs nothing; what sticks stops, r = -q; what slides stops along
# the normal and is braked by mu r_n against its motion.
SOLVED = {
    "opens": (one_contact([1.0, 2.0, 0.0]), [0.0, 0.0, 0.0]),
    "touches": (one_contact([0.0, 2.0, 0.0]), [0.0, 0.0, 0.0]),
    "sticks": (one_contact([-2.0, 0.6, 0.8]), [2.0, -0.6, -0.8]),
    "about to slide": (one_contact([-2.0, 0.6, -0.8]), [2.0, -0.6, 0.8]),
    "slides": (one_contact([-2.0, 3.0, 4.0]), [2.0, -0.6, -0.8]),
    "without friction": (one_contact([-2.0, 3.0, 4.0], mu=0.0), [2.0, 0.0, 0.0]),
    # w = u_n + target + gamma r_n = -2 + 0.5 + (1 + 0.25) r_n
    "soft, with a target": (one_contact([-2.0, 0, 0], gamma=0.25, target=0.5), [1.2, 0.0, 0.0]),
    "nothing moves": (one_contact([0.0, 0.0, 0.0]), [0.0, 0.0, 0.0]),
}


@pytest.mark.parametrize(("problem", "impulse"), SOLVED.values(), ids=SOLVED)
def test_every_part_is_zero_at_a_solution(problem, impulse: list[float]) -> None:
    found = residual(problem, np.array([impulse]))
    # A dozen operations on numbers up to 5 m/s.
    bound = 12 * EPS * 5.0
    assert found.scaled <= bound
    assert found.local <= bound
    for part in (found.natural, found.signorini, found.cone, found.dissipation):
        assert part.largest <= bound
        assert part.contact == 0


# r = 0 where the contact closes: the map is P_K(-uh), and uh_n = -2 + 0.5 * 5 opens when it slides.
def test_no_impulse_on_a_closing_contact_misses_the_projection_of_its_velocity() -> None:
    found = residual(one_contact([-2.0, 0.0, 0.0]), np.zeros((1, 3)))
    assert found.scaled == found.local == 1.0  # P_K(2, 0, 0), of |q| = 2
    assert found.signorini == (2.0, 0)
    assert found.cone == (0.0, 0)


def test_each_part_names_the_contact_that_breaks_its_law() -> None:
    q = np.array([[1.0, 0, 0], [-1.0, 0, 0], [-1.0, 0, 0], [-1.0, 3.0, 0]])
    problem = problem_of(sparse.eye(12, format="csc"), q, np.full(4, 0.5))
    solved = np.array([[0.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0], [1.0, -0.5, 0]])
    assert residual(problem, solved).scaled == 0.0
    broken = solved.copy()
    broken[0] = [-0.25, 0.0, 0.0]  # pulls: Signorini, and the cone
    assert residual(problem, broken).signorini == (0.25, 0)
    assert residual(problem, broken).cone == (0.25, 0)
    broken = solved.copy()
    broken[2] = [1.0, 1.0, 0.0]  # leaves the cone: (1, 1) is nearest to (1.2, 0.6)
    found = residual(problem, broken)
    assert found.cone.contact == 2
    assert found.cone.largest == pytest.approx(np.hypot(0.2, 0.4), rel=8 * EPS)
    broken = solved.copy()
    broken[3] = [1.0, 0.3, 0.0]  # pushes with the motion: u = 3.3, braked by -0.5 instead
    found = residual(problem, broken)
    assert found.dissipation.contact == found.natural.contact == 3
    assert found.dissipation.largest == pytest.approx(0.8, rel=8 * EPS)
    assert found.signorini == (0.0, 0)


def test_without_velocities_only_nothing_is_a_solution() -> None:
    problem = one_contact([0.0, 0.0, 0.0])
    assert residual(problem, np.zeros((1, 3)))[:2] == (0.0, 0.0)
    assert residual(problem, np.array([[1e-300, 0.0, 0.0]]))[:2] == (np.inf, np.inf)


def test_the_short_way_gives_the_same_numbers() -> None:
    problem = random_problem(5)
    r = np.random.default_rng(5).normal(size=(problem.contacts, 3))
    assert distances(problem, r) == residual(problem, r)[:2]


def test_what_is_too_large_for_squares_is_far() -> None:
    problem = random_problem(2)
    assert residual(problem, np.full((problem.contacts, 3), 1e307)).scaled > 1e300


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_is_infinitely_far(bad: float) -> None:
    problem = random_problem(2)
    impulses = np.zeros((problem.contacts, 3))
    impulses[1, 2] = bad
    assert residual(problem, impulses)[:2] == (np.inf, np.inf)


def test_a_second_algorithm_runs_into_it() -> None:
    """Gauss-Seidel knows nothing of De Saxce's cone; where it stops, the residual is round-off."""
    problem = random_problem(21)
    history = [
        residual(problem, solve_by_gauss_seidel(problem, sweeps)).scaled for sweeps in (0, 4, 400)
    ]
    assert history[0] > history[1] > history[2]
    # u is a sum of 3 n terms of the size of c r, a few times |q| here.
    assert history[2] <= 3 * problem.contacts * 10 * EPS


def test_the_two_scales_agree_where_all_contacts_are_alike_and_only_there() -> None:
    alike = problem_of(sparse.eye(6, format="csc"), np.full((2, 3), -1.0), np.full(2, 0.3))
    r = np.array([[1.0, 0.1, 0.0], [0.2, 0.0, 0.3]])
    assert residual(alike, r).scaled == residual(alike, r).local
    blocks = alike.blocks.copy()
    blocks[0] *= 1e4
    found = residual(alike._replace(blocks=blocks), r)
    assert found.scaled != found.local
