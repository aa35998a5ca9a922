"""Words of several threads: no sum is lost, one of them raises a word, and who waits goes on."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from lavendersim.engine import atomics
from lavendersim.engine.compile import inner

pytestmark = pytest.mark.skipif(not atomics.CAN_WAIT, reason="threads wait by what POSIX has")
THREADS, TIMES = 4, 20_000


@inner
def add_often(words, times):
    for _ in range(times):
        atomics.fetch_add(words, 1, 3)


@inner
def raise_each(words, won, times):
    """Of every value that words[0] is raised to, note who did it."""
    for value in range(1, times + 1):
        if atomics.raise_to(words, 0, value):
            won[value] += 1


@inner
def change(words):
    """Return what a word is before and after a store, a sum, and a vain and a true raise."""
    atomics.store(words, 2, 5)
    before = atomics.fetch_add(words, 2, 2)
    vain = atomics.raise_to(words, 2, 7)
    true = atomics.raise_to(words, 2, 8)
    return before, vain, true, atomics.load(words, 2)


@inner
def follow(words, other, times):
    """Count words[0] up in turns with another thread, which counts when it is odd."""
    for _ in range(times):
        spins = 0
        while atomics.load(words, 0) % 2 != other:
            spins = atomics.wait(spins)
        words[1] += 1  # never at the same time: a sum without atoms stays right
        atomics.fetch_add(words, 0, 1)


def in_threads(count, call) -> None:
    call(0)  # compiled in one thread
    with ThreadPoolExecutor(count) as pool:
        list(pool.map(call, [1] * count))


def test_words_are_read_and_written_as_said() -> None:
    words = np.zeros(4, np.int64)
    assert change(words) == (5, False, True, 8)
    assert words.tolist() == [0, 0, 8, 0]


def test_no_sum_is_lost() -> None:
    words = np.zeros(2, np.int64)
    in_threads(THREADS, lambda on: add_often(words, on * TIMES))
    assert words.tolist() == [0, 3 * THREADS * TIMES]


def test_one_thread_raises_a_word_to_a_value_at_most() -> None:
    """Each of them has an array of its own, so that a lost sum hides nothing."""
    words, won = np.zeros(1, np.int64), np.zeros((THREADS, TIMES + 1), np.int64)
    raise_each(words, won[0], 0)
    with ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(lambda own: raise_each(words, own, TIMES), won))
    assert words[0] == TIMES
    assert won.sum(axis=0)[-1] == 1  # the last value is raised to, earlier ones may be jumped over
    assert won.sum(axis=0).max() == 1


def test_two_threads_take_turns() -> None:
    words = np.zeros(2, np.int64)
    follow(words, 0, 0)
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda other: follow(words, other, 200), range(2)))
    assert words.tolist() == [400, 400]
