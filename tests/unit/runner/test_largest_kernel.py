"""Where a column is largest and what another counts: by the kernel as numpy finds them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lavendersim.runner.largest_kernel import largest_of


def steps(residuals: list[float], limits: list[int]) -> NDArray[Any]:
    rows = np.zeros(len(residuals), [("step", "i8"), ("residual", "f8"), ("at_limit", "i8")])
    rows["residual"], rows["at_limit"] = residuals, limits
    return rows


def test_the_first_of_equal_numbers_is_found_and_the_first_that_is_none_before_any() -> None:
    for numbers in (
        [0.0],
        [-1.0, -0.5, -0.5],
        [1.0, 3.0, 3.0, 2.0],
        [1.0, math.nan, 9.0, math.nan],
        [math.nan, 1.0],
        [1.0, math.inf, math.inf],
    ):
        found = largest_of(steps(numbers, [0] * len(numbers)), ("residual",), ())
        assert found.rows == [int(np.argmax(numbers))], numbers


def test_counts_are_summed_and_so_are_the_steps_that_have_any() -> None:
    rows = steps([0.0] * 4, [0, 2, 0, 5])
    found = largest_of(rows, ("residual", "residual"), ("at_limit", "step"))
    assert found == ([0, 0], [7, 0], [2, 0])


def test_rows_with_room_behind_them_are_read_alike() -> None:
    row = {"names": ["residual"], "formats": ["f8"], "offsets": [0], "itemsize": 16}
    rows: NDArray[Any] = np.zeros(3, np.dtype(row))  # type: ignore[call-overload]
    rows["residual"] = [1.0, 4.0, 2.0]
    assert largest_of(rows, ("residual",), ()).rows == [1]
