"""What is lowered directly does as numba's own lowering: exceptions, indices from the end."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, inner

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")


def half_or_raise(x):
    if x < 0.0:
        raise ValueError("negative")
    return 0.5 * x


def arithmetic(rows, i, x):
    total = rows[i].speed - x * rows[-1].speed + x / rows[0].speed
    rows[i].count = rows[i].count * 3 + i - 7
    return total, x != x, x < total, rows[i].count >= i, -0.0 * x


def test_exception_of_a_part_reaches_the_caller():
    part = inner(half_or_raise)

    def through(x):
        return part(x)

    called = inner(through)
    assert called(3.0) == 1.5
    with pytest.raises(ValueError, match="negative"):
        called(-1.0)


@pytest.mark.parametrize("x", [0.1, -3.7, np.nan, np.inf])
@pytest.mark.parametrize("i", [0, 1, -2])
def test_same_bits_as_by_numba(i, x):
    rows = np.zeros(3, np.dtype([("speed", "f8"), ("count", "i8")], align=True))
    rows["speed"], rows["count"] = [0.3, 1.7, -2.9], [5, -6, 7]
    ours, theirs = rows.copy(), rows.copy()
    found = inner(arithmetic)(ours, i, x)
    expected = numba.njit(error_model="numpy")(arithmetic)(theirs, i, x)
    assert np.array(found).tobytes() == np.array(expected).tobytes()
    assert ours.tobytes() == theirs.tobytes()
