"""Loops over ranges visit what Python's do, and raise nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, inner

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")


def make_note(step: Any) -> Any:
    """Return a function that notes what a range with this step visits, and a loop within."""

    def note(start, stop, seen):
        count = 0
        for k in range(start, stop, step):
            for j in range(2):
                seen[count] = 10 * k + j
                count += 1
                if count > 30:
                    break
            if count > 30:
                break
        return count

    return note


@pytest.mark.parametrize("step", [1, -1, 2, -3, 7])
def test_every_number_is_visited_in_order(step):
    kernel = inner(make_note(step))
    for start in (-3, 0, 4):
        for stop in (-9, -1, 0, 5, 12, 90):
            ours, theirs = np.zeros(40, np.int64), np.zeros(40, np.int64)
            count = make_note(step)(start, stop, theirs)
            assert kernel(start, stop, ours) == count
            assert (ours == theirs).all()


def test_one_or_two_ends_and_a_variable_after_the_loop():
    def loops(n):
        last = -5
        total = 0
        for last in range(n):
            total += last
        for k in range(3, n):
            total += 100 * k
        return total, last

    for n in (-1, 0, 1, 6):
        assert inner(loops)(n) == loops(n)


def test_a_step_that_is_not_known_is_numbas():
    def loop(step):
        total = 0
        for k in range(0, 10, step):
            total += k
        return total

    kernel = inner(loop)
    assert [kernel(step) for step in (1, 3, -1)] == [45, 18, 0]
    with pytest.raises(ValueError, match="zero"):
        kernel(0)


def test_a_kernel_with_a_loop_raises_nothing():
    def loop(n):
        total = 0
        for k in range(n):
            total += k
        return total

    part = inner(loop)

    def caller(n):
        return part(n)

    assert inner(caller)(4) == 6
    (linked,) = part.linked.values()
    assert not linked.part.raises
