"""A factorised system solves what is kept, leaves the rest 0, and is the same full or sparse."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from lavendersim.problems.factorise import SMALL, factorise
from lavendersim.problems.matrices import problem_of
from lavendersim.problems.scaled_problem import ScaledProblem, scale

RANDOM = np.random.default_rng(8)


def made(contacts: int) -> ScaledProblem:
    """Return a scaled problem of neighbours in a row."""
    size = 3 * contacts
    band = sparse.diags(
        [np.full(size, 4.0), np.full(size - 3, -1.0), np.full(size - 3, -1.0)], [0, -3, 3]
    )
    return scale(problem_of(band, RANDOM.normal(size=(contacts, 3)), np.full(contacts, 0.5)))


@pytest.mark.parametrize("contacts", [4, SMALL // 3 + 10])
def test_kept_rows_solve_their_system_and_the_others_are_zero(contacts: int) -> None:
    p = made(contacts)
    keep = RANDOM.random((contacts, 3)) < 0.95
    keep[0] = [True, False, False]
    diagonal = RANDOM.uniform(0.1, 1.0, (contacts, 3))
    assert (keep.sum() > SMALL) == (contacts > SMALL // 3)
    right = RANDOM.normal(size=(contacts, 3))
    z = factorise(p, p.blocks, keep, diagonal).solve(right)
    assert not z[~keep].any()
    left = (p.matrix @ z.ravel()).reshape(-1, 3) + diagonal * z
    # Diagonally dominant, of a condition below 10: some roundings of numbers of a few units.
    assert left[keep] == pytest.approx(right[keep], abs=1e-13)


def test_a_singular_system_has_no_finite_solution() -> None:
    p = made(4)
    nothing = np.zeros_like(p.blocks)
    z = factorise(p, nothing, np.ones((4, 3), bool)).solve(np.ones((4, 3)))
    assert not np.isfinite(z).all()


def test_nothing_kept_is_nothing_moved() -> None:
    p = made(4)
    assert not factorise(p, p.blocks, np.zeros((4, 3), bool)).solve(np.ones((4, 3))).any()
