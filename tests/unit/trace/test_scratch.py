"""Scratch memory belongs to one thread, and serves it again."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pytest

from lavendersim.trace.scratch import scratch


@pytest.mark.parametrize("shape", [(0,), (7,), (2, 3), (8, 0, 4)])
def test_it_has_the_shape_and_kind_asked_for(shape: tuple[int, ...]) -> None:
    found = scratch("shapes", shape, np.uint64)
    assert found.shape == shape
    assert found.dtype == np.uint64
    assert found.flags.c_contiguous


def test_smaller_arrays_lie_in_the_memory_of_larger_ones() -> None:
    large = scratch("again", (100,), np.float64)
    assert np.shares_memory(large, scratch("again", (50,), np.uint8))
    assert not np.shares_memory(large, scratch("other", (50,), np.uint8))
    assert not np.shares_memory(large, scratch("again", (101,), np.float64))


def test_no_two_threads_share_memory() -> None:
    together = Barrier(2)  # neither ends before the other has its own

    def own() -> np.ndarray:
        found = scratch("threads", (10,), np.int64)
        together.wait()
        return found

    with ThreadPoolExecutor(2) as pool:
        one, other = (each.result() for each in [pool.submit(own), pool.submit(own)])
    assert not np.shares_memory(one, other)
