"""Random contact problems by their Delassus matrix, sparse by blocks, and the dense matrix."""

from __future__ import annotations

import gauss_seidel
import numpy as np

from lavendersim.engine.contact_problem import ContactProblem


def random_problem(rng: np.random.Generator, contacts: int, coupled: float = 0.5) -> ContactProblem:
    """Return W = J M^-1 J^T of contacts between random unit bodies, free velocities that close.

    coupled: share of the contacts that share a body with the one before.
    """
    bodies = contacts + 1
    jacobian = np.zeros((3 * contacts, 3 * bodies))
    for k in range(contacts):
        own = slice(3 * (k + 1), 3 * (k + 2))
        other = k if rng.random() < coupled else None
        jacobian[3 * k : 3 * k + 3, own] = rng.normal(size=(3, 3)) + 2 * np.eye(3)
        if other is not None:
            jacobian[3 * k : 3 * k + 3, 3 * other : 3 * other + 3] = -rng.normal(size=(3, 3))
    matrix = jacobian @ jacobian.T
    begin, row, blocks = [0], [], []
    for j in range(contacts):
        for i in range(contacts):
            block = matrix[3 * i : 3 * i + 3, 3 * j : 3 * j + 3]
            if i == j or block.any():
                row.append(i)
                blocks.append(block)
        begin.append(len(row))
    return ContactProblem(
        np.array(begin),
        np.array(row),
        np.array(blocks),
        rng.normal(size=(contacts, 3)) - [1.0, 0.0, 0.0],
        rng.uniform(0.2, 0.8, contacts),
        rng.uniform(0.0, 0.2, contacts),
        rng.uniform(-0.1, 0.1, contacts),
    )


def dense(problem: ContactProblem) -> np.ndarray:
    """Return W without its regularisation, (3n, 3n)."""
    return gauss_seidel.dense(problem._replace(gamma=np.zeros(problem.contacts)))[0]
