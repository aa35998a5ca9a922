"""A sparse matrix to blocks and back, with a block of its own for every contact."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from lavendersim.problems.matrices import matrix_of, problem_of
from lavendersim.problems.residual import contact_velocities

RANDOM = np.random.default_rng(5)


def made(contacts: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a full matrix that is not symmetric, of which some blocks are 0, and velocities."""
    blocks = RANDOM.normal(size=(contacts, 3, contacts, 3))
    blocks[0, :, 2, :] = 0.0
    blocks[1, :, 1, :] = 0.0
    return blocks.reshape(3 * contacts, 3 * contacts), RANDOM.normal(size=(contacts, 3))


def test_there_and_back_it_is_the_same_matrix() -> None:
    matrix, free = made(4)
    problem = problem_of(sparse.csr_matrix(matrix), free, np.full(4, 0.5))
    assert (matrix_of(problem).toarray() == matrix).all()
    assert problem.contacts == 4
    assert len(problem.row) == 15  # of 16 blocks one is 0, the other zero one is a contact's own
    assert not problem.own_blocks[1].any()


def test_velocities_are_the_matrix_times_impulses() -> None:
    matrix, free = made(4)
    problem = problem_of(sparse.coo_matrix(matrix), free.ravel(), np.zeros(4))
    impulses = RANDOM.normal(size=(4, 3))
    expected = (matrix @ impulses.ravel()).reshape(4, 3) + free
    # 12 products of numbers of some units: a few roundings of 1e-15
    assert contact_velocities(problem, impulses) == pytest.approx(expected, abs=2e-14)


def test_regularisation_stands_on_the_normal_diagonal() -> None:
    matrix, free = made(3)
    problem = problem_of(sparse.csc_matrix(matrix), free, np.zeros(3))
    problem = problem._replace(gamma=np.array([0.5, 0.0, 2.0]))
    added = matrix_of(problem).toarray() - matrix
    expected = np.zeros((9, 9))
    expected[0, 0], expected[6, 6] = 0.5, 2.0
    assert added == pytest.approx(expected, abs=1e-15)
