"""Cells of arrays of several axes are read and written where numpy has them."""

import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, inner

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")


def cells(a, b, i, j):
    a[i, 1] = a[j, i] + a[-1, -2]
    a[1, j] = 2.5 * a[1, 2]
    b[1, i, -1] = b[i, j, 0] + b[0, -1, j]
    return a[i, j], b[-1, 1, i]


def unsigned(a, i):
    return a[i, i], a[0, i]


@pytest.mark.parametrize("i", [0, 1, -1, -3])
@pytest.mark.parametrize("j", [0, 2, -2])
def test_as_numpy(i, j):
    a, b = np.arange(12.0).reshape(3, 4), np.arange(27).reshape(3, 3, 3)
    ours, theirs = (a.copy(), b.copy()), (a.copy(), b.copy())
    assert inner(cells)(*ours, i, j) == cells(*theirs, i, j)
    assert all(map(np.array_equal, ours, theirs))


def test_an_unsigned_index_counts_from_the_begin():
    a = np.arange(12.0).reshape(3, 4)
    assert inner(unsigned)(a, np.uint64(2)) == (10.0, 2.0)


@pytest.mark.parametrize("order", ["F", "A"])
def test_arrays_in_another_order(order):
    a, b = np.arange(12.0).reshape(3, 4), np.arange(27).reshape(3, 3, 3)
    other = np.asfortranarray(a) if order == "F" else np.arange(24.0).reshape(3, 8)[:, ::2]
    expected = cells(other.copy(), b.copy(), 1, 2)
    assert inner(cells)(other, b, 1, 2) == expected
