"""Rounds of a linear function end at its fixed point by as many columns as it has eigenvalues."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted

from lavendersim.engine.anderson import DEPTH, NO_ROUND, allocate_fixed_point, make_bring_on
from lavendersim.engine.spec import Spec

SIZE = 5
BRING_ON = interpreted(make_bring_on(Spec()))
# g(x) = ALONE + A x with eigenvalues 0.95 (once) and 0.2: plain rounds leave 95 % of the error.
FACTORS = 0.2 * np.eye(SIZE) + 0.15 * np.ones((SIZE, SIZE))
ALONE = np.array([1.0, -0.5, 0.8, 0.3, 0.1])
END = np.linalg.solve(np.eye(SIZE) - FACTORS, ALONE)


def rounds(factors: np.ndarray, many: int, kept: int = NO_ROUND) -> tuple[np.ndarray, int]:
    """Return the point after so many rounds, and the columns that are kept."""
    fixed = allocate_fixed_point(SIZE)
    for _ in range(many):
        fixed.defect[:] = ALONE + factors @ fixed.point - fixed.point
        kept = BRING_ON(fixed, SIZE, kept)
    return fixed.point, kept


def test_the_first_round_is_a_plain_one() -> None:
    point, columns = rounds(FACTORS, 1)
    assert columns == 0
    assert point == pytest.approx(ALONE, rel=1e-15)


def test_two_columns_end_a_linear_function_of_two_eigenvalues() -> None:
    """The third round has them; round-off of the differences counts 1 / (1 - 0.95) times."""
    point, columns = rounds(FACTORS, 3)
    assert columns == 2
    assert point == pytest.approx(END, rel=1e-12)


def test_rounds_that_would_part_from_the_fixed_point_come_to_it() -> None:
    """Eigenvalue -1.5: each plain round makes the error half as large again."""
    factors = -1.5 * np.eye(SIZE)
    point, _ = rounds(factors, 2)
    assert point == pytest.approx(ALONE / 2.5, rel=1e-12)


def test_at_the_fixed_point_nothing_moves_and_nothing_is_divided_by_zero() -> None:
    point, columns = rounds(FACTORS, 12)
    assert columns == DEPTH
    assert point == pytest.approx(END, rel=1e-12)


def test_what_is_hardly_new_in_a_column_is_not_multiplied() -> None:
    """A curved function of three numbers, with what solves leave: four columns cannot all be new.

    g contracts by 0.6 and its curvature by 1 at the start (0.3): near the end every round gains. A
    column of which a share s is new takes the noise of 1e-10 1/s times into the next point.
    """
    for seed in range(20):
        rng = np.random.default_rng(seed)
        factors, bends = rng.normal(size=(3, 3)), rng.normal(size=(3, 3, 3))
        factors, bends = 0.6 * factors / np.linalg.norm(factors, 2), bends / np.linalg.norm(bends)
        fixed, columns, least = allocate_fixed_point(3), NO_ROUND, np.inf
        fixed.point[:] = rng.normal(size=3) * 0.17
        for _ in range(16):
            x = fixed.point
            led_to = factors @ x + np.einsum("ijk,j,k", bends, x, x)
            fixed.defect[:] = led_to - x + 1e-10 * rng.normal(size=3)
            missed = float(np.linalg.norm(fixed.defect))
            assert least > 1e-3 or missed < max(least, 1e-8)
            least = min(least, missed)
            columns = BRING_ON(fixed, 3, columns)
        assert least < 1e-9


def test_a_number_that_is_none_moves_no_other() -> None:
    """A body that diverges does not take the others along; what is NaN stays so."""
    fixed, columns = allocate_fixed_point(2), NO_ROUND
    for defect in ([1.0, np.nan], [0.5, np.nan], [0.25, np.nan]):
        fixed.defect[:] = defect
        columns = BRING_ON(fixed, 2, columns)
    assert fixed.point[0] == 1.75
    assert np.isnan(fixed.point[1])
