"""Three values of one number give its order and its limit, where it has them, and say where not.

Values are made of f(h) = f + C h^p, so what must come out is what they were made of.
"""

from __future__ import annotations

from math import isnan, nan

import numpy as np
import pytest

from lavendersim.measures.time_errors import time_error, time_error_of

LIMIT, COEFFICIENT = 3.0, -0.7


def values(order: float, timestep: float = 0.1) -> list[float]:
    return [LIMIT + COEFFICIENT * (timestep / divisor) ** order for divisor in (1, 2, 4)]


@pytest.mark.parametrize("order", [0.5, 1.0, 1.5, 2.0])
def test_a_power_of_the_timestep_gives_its_order_its_limit_and_its_error(order: float) -> None:
    found = time_error(*values(order))
    # Differences of numbers of size 3 are off by 2^-52 * 3 each, and are 1e-3 and more.
    assert found.order == pytest.approx(order, abs=1e-11)
    assert found.extrapolated == pytest.approx(LIMIT, abs=1e-12)
    assert found.error == pytest.approx(COEFFICIENT * 0.1**order, abs=1e-12)
    assert found.bar == pytest.approx(abs(COEFFICIENT) * 0.025**order, abs=1e-12)
    assert found.change == pytest.approx(COEFFICIENT * (0.05**order - 0.1**order), abs=1e-14)


def test_no_order_above_two_is_trusted() -> None:
    found = time_error(*values(6.0))
    assert found.order == pytest.approx(6.0, abs=1e-6)
    second = values(6.0)[2] - values(6.0)[1]
    assert found.bar == pytest.approx(abs(second) / 3.0)  # 2^2 - 1


@pytest.mark.parametrize(
    ("rows", "note"),
    [((1.0, 2.0, 3.0), "do not shrink"), ((1.0, 2.0, 1.5), "alternate"), ((1.0, 1.0, 2.0), "do")],
)
def test_what_fits_no_power_has_no_order_but_a_spread(
    rows: tuple[float, float, float], note: str
) -> None:
    found = time_error(*rows)
    assert isnan(found.order)
    assert note in found.note
    assert found.extrapolated == rows[2]
    assert found.bar == max(abs(rows[0] - rows[1]), abs(rows[1] - rows[2]), abs(rows[0] - rows[2]))


def test_numbers_as_good_as_the_solver_are_equal() -> None:
    found = time_error(5.0, 5.0 + 1e-9, 5.0 - 1e-9)
    assert "equal" in found.note
    assert (found.extrapolated, isnan(found.order)) == (5.0 - 1e-9, True)
    assert "equal" in time_error(0.0, 0.0, 0.0).note
    assert "equal" in time_error(1e-15, -3e-15, 2e-14).note  # round-off of numbers of size one


@pytest.mark.parametrize("rows", [(nan, 1.0, 1.0), (1.0, float("inf"), 1.0)])
def test_what_is_no_number_gives_no_estimate(rows: tuple[float, float, float]) -> None:
    found = time_error(*rows)
    assert isnan(found.extrapolated)
    assert isnan(found.bar)
    assert "not a number" in found.note


def test_of_a_row_the_number_that_changes_most_is_taken() -> None:
    rows = np.array([values(1.0), values(2.0), [1.0, 1.0, 1.0]]).T
    assert time_error_of(list(rows)).order == pytest.approx(1.0)


def test_rows_of_other_lengths_and_texts_say_so() -> None:
    assert time_error_of([[1.0], [1.0, 2.0], [1.0]]).note == "rows of 1, 2, 1 numbers"
    assert time_error_of([[], [], []]).note == "rows without a number"
    assert time_error_of([1.0, "no contact", 1.0]).note == "no contact"
