"""What a cell frees is there for the next one, without a page from the system."""

from __future__ import annotations

import ctypes
import resource

import numpy as np
import pytest

from lavendersim.runner.freed_memory import KEPT, OWN_PAGES, keep_freed_memory

ARRAYS, WORDS = 8, 250_000  # 16 MB, in arrays that have no pages of their own
ROUNDS = 20


def faults() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt


def take_and_free() -> None:
    arrays = [np.ones(WORDS) for _ in range(ARRAYS)]
    del arrays


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "mallopt"), reason="no glibc")
def test_pages_that_are_freed_are_taken_again() -> None:
    size = 8 * WORDS
    assert size < OWN_PAGES
    assert ARRAYS * size < KEPT
    keep_freed_memory()
    take_and_free()
    before = faults()
    for _ in range(ROUNDS):
        take_and_free()
    # Every page anew would be 16 MB / 4 kB = 3,906 faults a round; other work of the process
    # has a few.
    assert faults() - before < ROUNDS * 3_906 / 20
