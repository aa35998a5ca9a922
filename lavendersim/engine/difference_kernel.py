"""Kernels that write numbers of a log as differences to what is expected, byte plane by plane.

Of each column every predictor (`trace.predictors`) is tried on a part of its rows, and the one
taken that leaves the fewest bytes behind zeros. Compiled once, for the contacts of all logs.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from .compile import compiling, inner
from .kernel_cache import cached
from .spec import Spec

U = np.uint64
COUNT = 8
XOR, DELTA, LINEAR, UNIT, AFTER, GAP, LAW, SPHERES = range(COUNT)  # as in `trace.predictors`
ALONE = 3  # predictors that need no other column
PART = 2048  # rows at a time: what is made of them stays in the processor's cache
TRIED, SAMPLE = 256, 4  # rows on which predictors are tried: so many, once in so many times that


def _fold(difference):
    """Return a signed difference with its sign in the lowest bit."""
    return (difference << U(1)) ^ (U(0) - (difference >> U(63)))


def _bytes_of(word):
    """Return how many bytes a number has from its first that is not 0, without a branch."""
    count = U(word != U(0))
    for k in range(U(1), U(8)):
        count += U(word >> U(8) * k != U(0))
    return count


def _make_difference(spec: Spec):
    fold = inner(_fold)

    def difference(predictor, own, before, rise, expected):
        if predictor == XOR:
            return own ^ before
        if predictor == DELTA:
            return fold(own - before)
        if predictor == LINEAR:
            return fold(own - before - rise)
        if predictor in (AFTER, SPHERES):
            return fold(own - expected)
        return own ^ expected

    return inner(difference)


def _make_differences(spec: Spec):
    difference = _make_difference(spec)

    def differences(predictor, words, rows, expected, begin, out):
        """Fill `out` with the differences of as many rows, from `begin` on.

        A loop for each predictor, without branches: numbers go eight at a time.
        """
        persists, known = rows
        first, last = U(begin), U(begin + len(out))
        for i in range(first, min(max(first, U(2)), last)):  # the first two of all
            before = words[U(0)] if i == U(1) and persists[i] else U(0)
            guess = LINEAR if predictor == SPHERES and not known[i] else predictor
            out[i - first] = difference(guess, words[i], before, U(0), expected[i])
        begin = max(first, U(2))
        if predictor == XOR:
            for i in range(begin, last):
                before = words[i - U(1)] & (U(0) - U(persists[i]))
                out[i - first] = difference(XOR, words[i], before, U(0), U(0))
        elif predictor == DELTA:
            for i in range(begin, last):
                before = words[i - U(1)] & (U(0) - U(persists[i]))
                out[i - first] = difference(DELTA, words[i], before, U(0), U(0))
        elif predictor == LINEAR:
            for i in range(begin, last):
                follows = U(0) - U(persists[i])
                # The first of a key has no rise: the second is expected to be as it was.
                goes_on = follows & (U(0) - U(persists[i - U(1)]))
                before, rise = words[i - U(1)] & follows, words[i - U(1)] - words[i - U(2)]
                out[i - first] = difference(LINEAR, words[i], before, rise & goes_on, U(0))
        elif predictor == SPHERES:
            for i in range(begin, last):
                follows = U(0) - U(persists[i])
                goes_on = follows & (U(0) - U(persists[i - U(1)]))
                before, rise = words[i - U(1)] & follows, words[i - U(1)] - words[i - U(2)]
                other = difference(LINEAR, words[i], before, rise & goes_on, U(0))
                own = difference(SPHERES, words[i], U(0), U(0), expected[i])
                by_poses = U(0) - U(known[i])
                out[i - first] = (own & by_poses) | (other & ~by_poses)
        elif predictor == AFTER:
            for i in range(begin, last):
                out[i - first] = difference(AFTER, words[i], U(0), U(0), expected[i])
        else:
            for i in range(begin, last):
                out[i - first] = difference(UNIT, words[i], U(0), U(0), expected[i])

    return inner(differences)


def _make_sizes(spec: Spec):
    differences, bytes_of = _make_differences(spec), inner(_bytes_of)

    def sizes(words, rows, expected, special, size, some):
        """Count the bytes that a column takes by each predictor, of some of its rows."""
        persists, known = rows
        for begin in range(0, len(words), TRIED * SAMPLE):
            tried = slice(begin, min(begin + TRIED, len(words)))
            mine, own = words[tried], (persists[tried], known[tried])
            for predictor in range(COUNT):
                if predictor < ALONE or predictor == special:
                    out, total = some[: len(mine)], U(0)
                    differences(predictor, mine, own, expected[tried], 0, out)
                    for i in range(U(1), U(len(mine))):
                        total += bytes_of(out[i]) * U(own[0][i])
                    size[predictor] += total

    return inner(sizes)


def _make_pack(spec: Spec):
    differences, sizes = _make_differences(spec), _make_sizes(spec)

    def pack(words, rows, special, expected, size, packed):
        chosen, planes, some = packed
        other_of = 0
        for j in range(words.shape[0]):
            size[:] = 0
            hopes = expected[other_of]
            if special[j] >= ALONE:
                other_of += 1
            sizes(words[j], rows, hopes, special[j], size, some)
            choice = XOR
            for other in range(DELTA, COUNT):
                if (other < ALONE or other == special[j]) and size[other] < size[choice]:
                    choice = other
            chosen[j] = choice
            for begin in range(0, words.shape[1], len(some)):
                end = min(begin + len(some), words.shape[1])
                out = some[: end - begin]
                differences(choice, words[j], rows, hopes, begin, out)
                for k in range(8):
                    plane = planes[7 - k, j, begin:end]
                    for i in range(U(len(out))):
                        plane[i] = np.uint8(out[i] >> U(8 * k))

    return inner(pack)


def _make_gather(spec: Spec):
    def gather(rows, first, order, columns, words):
        count = len(rows)
        for i in range(U(len(order))):
            row = order[i] - first
            if row >= 0 and row < count:
                for j in range(U(len(columns))):
                    words[j, i] = rows[U(row), U(columns[j])]

    return inner(gather)


@cache
def gather_columns():
    """Return `kernel(rows, first, order, columns, words)`.

    words[j, i] = rows[order[i] - first, columns[j]], where that is one of these rows: they are a
    part of all, from `first` on. rows: (n, k), words: (m, all), uint64; order: (all,), columns:
    (m,), int64.
    """
    kernel = cached(_make_gather, Spec())
    words, ints = np.zeros((0, 0), np.uint64), np.zeros(0, np.int64)
    with compiling():
        kernel(words, 0, ints, ints, words)
    return kernel


@cache
def pack_columns():
    """Return `kernel(words, rows, special, expected, size, packed)`.

    words: (m, n) of columns, rows in the order of their keys. rows: persists and known, (n,) bool,
    whether a row follows one of its key, and whether SPHERES expects it. special: (m,) predictor
    beside those that need no other column, 0 for none. expected: (k + 1, n) what the k of these
    expect, in their order; the last is not read.
    size: (COUNT,) to work in. packed: predictors (m,) and uint8 planes (8, m, n), to be filled, and
    (PART,) to work in.
    Words are uint64, else int64.
    """
    kernel = cached(_make_pack, Spec())
    words, ints = np.zeros((0, 0), np.uint64), np.zeros(0, np.int64)
    packed = ints, np.zeros((8, 0, 0), np.uint8), np.zeros(PART, np.uint64)
    with compiling():  # here, and not in one of the threads that close chunks
        kernel(words, (np.zeros(0, np.bool_),) * 2, ints, words, ints, packed)
    return kernel
