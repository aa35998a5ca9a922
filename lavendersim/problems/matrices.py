"""Conversion between a sparse Delassus matrix W and a ContactProblem's 3x3 blocks by column.

W is taken as it is: what is not symmetric stays so. The block of every contact with itself is
stored even where the file has none, since every solver looks there first.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem

DIMENSION = 3  # rows per contact: normal, two tangents


def problem_of(matrix: Any, free: np.ndarray, mu: np.ndarray) -> ContactProblem:
    """Return the problem `u = W r + free` without regularisation and target.

    `matrix` (3n, 3n) [1/kg] sparse; `free` (3n,) or (n, 3) [m/s]; `mu` (n,) [-].
    """
    contacts = len(mu)
    entries = matrix.tocoo()
    own = entries.row // DIMENSION == entries.col // DIMENSION
    has_own = np.zeros(contacts, dtype=bool)
    has_own[entries.row[own] // DIMENSION] = True
    # One explicit zero opens the block of a contact that has none.
    lacking = DIMENSION * np.flatnonzero(~has_own)
    whole = sparse.coo_matrix(
        (
            np.concatenate([entries.data, np.zeros(len(lacking))]),
            (
                np.concatenate([entries.row, lacking]),
                np.concatenate([entries.col, lacking]),
            ),
        ),
        shape=(DIMENSION * contacts, DIMENSION * contacts),
    )
    # Blocks go row by row in this format: those of the transpose are W's, column by column.
    rows = whole.T.tocsr().tobsr((DIMENSION, DIMENSION))
    rows.sort_indices()
    return ContactProblem(
        begin=rows.indptr.astype(np.int64),
        row=rows.indices.astype(np.int64),
        blocks=np.ascontiguousarray(rows.data.transpose(0, 2, 1), dtype=np.float64),
        free=np.array(free, dtype=np.float64).reshape(contacts, DIMENSION),
        mu=np.array(mu, dtype=np.float64),
        gamma=np.zeros(contacts),
        target=np.zeros(contacts),
    )


def matrix_of(problem: ContactProblem) -> Any:
    """Return W + gamma on the normal diagonal [1/kg], a (3n, 3n) scipy matrix by columns.

    With it and `problem.q` the problem is `u = W r + q`, as other libraries write it.
    """
    regularised = problem.blocks.copy()
    own = problem.row == problem.columns
    regularised[own, 0, 0] += problem.gamma
    size = DIMENSION * problem.contacts
    transposed = sparse.bsr_matrix(
        (regularised.transpose(0, 2, 1), problem.row, problem.begin), shape=(size, size)
    )
    return transposed.tocsr().T.tocsc()
