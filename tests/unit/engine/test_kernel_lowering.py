"""Statements of a kernel: assignments of every kind, branches, fields that are set."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, inner

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")

ROW = np.dtype([("x", "f8"), ("n", "i8"), ("few", "i4")], align=True)


def statements(rows, x, flag):
    name, other = x, 7
    while other > 0 and rows[0].n < 20:
        if flag:
            name = -name
        rows[0].n += other
        other -= 2
    rows[1].x, rows[1].n = name, other
    rows[1].few = other  # of a width that numba's own lowering stores
    rows[2].n = 3  # a constant
    return name if name < 0.0 else rows[1].x * 2.0, not flag, -0.0


@pytest.mark.parametrize("flag", [True, False])
@pytest.mark.parametrize("x", [0.5, -2.5, np.nan])
def test_same_bits_as_by_numba(x, flag):
    ours, theirs = np.zeros(3, ROW), np.zeros(3, ROW)
    found = inner(statements)(ours, x, flag)
    expected = numba.njit(error_model="numpy")(statements)(theirs, x, flag)
    assert np.array(found).tobytes() == np.array(expected).tobytes()
    assert ours.tobytes() == theirs.tobytes()


def stores(numbers, counts, at, x):
    numbers[at], numbers[-1], numbers[0] = x, 2.0 * x, -0.0
    for k in range(1, counts.shape[0]):
        counts[k] = at - k
        counts[np.uint64(0)] = counts[k] * 3
    numbers[1] = counts[-2]  # a number of another type, which numba's own lowering stores
    return numbers[at]


@pytest.mark.parametrize("at", [3, -2])
def test_numbers_in_rows_are_stored_as_by_numba(at):
    ours, theirs = ((np.zeros(6), np.zeros(3, np.int64)) for _ in range(2))
    found = inner(stores)(*ours, at, -1.5)
    assert found == numba.njit(error_model="numpy")(stores)(*theirs, at, -1.5) == -1.5
    for own, of_numba in zip(ours, theirs, strict=True):
        assert own.tobytes() == of_numba.tobytes()
