"""The blocks of a problem are those of its dense matrix, column by column."""

from __future__ import annotations

import numpy as np
from problems_in_blocks import dense, random_problem


def test_columns_and_own_blocks_are_read_off_the_dense_matrix(rng) -> None:
    problem = random_problem(rng, 6)
    matrix = dense(problem)
    assert problem.contacts == 6
    assert len(problem.columns) == len(problem.blocks)
    for block, i, j in zip(problem.blocks, problem.row, problem.columns, strict=True):
        np.testing.assert_array_equal(matrix[3 * i : 3 * i + 3, 3 * j : 3 * j + 3], block)
    own = [matrix[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] for i in range(6)]
    np.testing.assert_array_equal(problem.own_blocks, own)


def test_q_has_the_target_in_its_normal_alone_and_is_a_copy(rng) -> None:
    problem = random_problem(rng, 4)
    q = problem.q
    np.testing.assert_array_equal(q[:, 1:], problem.free[:, 1:])
    np.testing.assert_array_equal(q[:, 0], problem.free[:, 0] + problem.target)
    q[:] = 0.0
    assert problem.free.any()
