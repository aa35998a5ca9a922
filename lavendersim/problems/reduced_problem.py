"""Reduction of a problem in the bodies' velocities to its contacts alone (the Delassus operator).

    M v = H r + f,   u = H' v + w     =>     W = H' M^-1 H,   q = w + H' M^-1 f
M need not be diagonal or symmetric; it is factorised once.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.errors import ProblemError
from lavendersim.problems.matrices import problem_of

# Columns solved for at a time: M^-1 H is as sparse as H for separate bodies, but is found as full
# columns, which must not all be in memory at once.
BATCH = 256


def reduce_to_contacts(
    file: Path, mass: Any, directions: Any, f: np.ndarray, w: np.ndarray, mu: np.ndarray
) -> ContactProblem:
    """Return the local form.

    `mass` (m, m) [kg], `directions` (m, 3n), both sparse; `f` (m,) [N s]; `w` (3n,) [m/s];
    `mu` (n,). `file` is named in a ProblemError, raised where the sizes differ or M is singular.
    """
    rows, columns = len(f), len(w)
    if mass.shape != (rows, rows):
        raise ProblemError(f"{file}: expected a square M, it is {mass.shape[0]} by {mass.shape[1]}")
    if directions.shape != (rows, columns):
        raise ProblemError(
            f"{file}: expected H with {rows} rows as M and {columns} columns, "
            f"it is {directions.shape[0]} by {directions.shape[1]}"
        )
    try:
        factors = splu(mass.tocsc())
    except RuntimeError:  # SuperLU: exactly singular
        raise ProblemError(f"{file}: expected an M that can be inverted, it is singular") from None
    by_columns = directions.tocsc()
    responses = [
        sparse.csc_matrix(factors.solve(by_columns[:, first : first + BATCH].toarray()))
        for first in range(0, columns, BATCH)
    ]
    delassus = by_columns.T @ sparse.hstack(responses, format="csc")
    q = w + by_columns.T @ factors.solve(f)
    if not (np.isfinite(q).all() and np.isfinite(delassus.data).all()):
        raise ProblemError(f"{file}: expected an M that can be inverted, it is nearly singular")
    return problem_of(delassus, q, mu)
