"""Anderson's acceleration: of a linear fixed point of n unknowns all is found in n + 1 passes."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine.acceleration import COLUMNS, advance_by, note_change


def found(matrix: np.ndarray, right: np.ndarray, passes: int) -> np.ndarray:
    """Return x after so many passes of x <- matrix x + right."""
    n = len(right)
    x, last_x, last_f = np.zeros(n), np.zeros(n), np.zeros(n)
    dx, df, columns = np.zeros((COLUMNS, n)), np.zeros((COLUMNS, n)), 0
    for number in range(passes):
        f = matrix @ x + right - x
        if number:
            dx[columns], df[columns] = x - last_x, f - last_f
            columns = note_change.py_func(dx, df, columns)
        last_x[:], last_f[:] = x, f
        advance_by.py_func(x, f, dx, df, columns)
    return x


@pytest.mark.parametrize("slow", [0.5, 0.999, 1.5, -3.0])
def test_linear_fixed_point_is_found_in_as_many_passes_as_it_has_directions(slow: float) -> None:
    """A factor of 0.999 would take ten thousand passes by itself; beyond 1 it would never end."""
    draw = np.random.default_rng(1)
    basis, _ = np.linalg.qr(draw.normal(size=(4, 4)))
    matrix = basis @ np.diag([slow, 0.3, -0.2, 0.7]) @ basis.T
    right = draw.normal(size=4)
    truth = np.linalg.solve(np.eye(4) - matrix, right)
    # Round-off of a system whose condition is some thousand.
    np.testing.assert_allclose(found(matrix, right, 6), truth, rtol=0.0, atol=1e-10 * 1e3)


def test_change_that_tells_nothing_new_is_no_column() -> None:
    dx, df = np.zeros((COLUMNS, 3)), np.zeros((COLUMNS, 3))
    df[0], dx[0] = (1.0, 2.0, 0.0), (1.0, 0.0, 0.0)
    assert note_change.py_func(dx, df, 0) == 1
    df[1], dx[1] = (2.0, 4.0, 0.0), (2.0, 0.0, 0.0)
    assert note_change.py_func(dx, df, 1) == 1
    assert np.linalg.norm(df[0]) == pytest.approx(1.0, abs=1e-15)
    assert note_change.py_func(dx, np.zeros((COLUMNS, 3)), 0) == 0
