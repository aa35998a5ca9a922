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
