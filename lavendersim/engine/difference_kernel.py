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
TRIED, SAMPLE = 256, 4  # rows on which predictors are tried: so many, once in so many times that


def _fold(difference):
    """Return a signed difference with its sign in the lowest bit."""
    return (difference << U(1)) ^ (U(0) - (difference >> U(63)))


def _bytes_of(word):
    """Return how many bytes a number has from its first that is not 0."""
    count = 0
    if word >> U(32) != U(0):
        count, word = 4, word >> U(32)
    if word >> U(16) != U(0):
        count, word = count + 2, word >> U(16)
    if word >> U(8) != U(0):
        return count + 2
    return count + 1 if word != U(0) else count


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


def _make_sizes(spec: Spec):
    difference, bytes_of = _make_difference(spec), inner(_bytes_of)

    def sizes(words, rows, expected, special, size):
        """Count the bytes that a column takes by each predictor, of some of its rows."""
        persists, known = rows
        for first in range(0, words.shape[0], TRIED * SAMPLE):
            before, rise = U(0), U(0)
            for i in range(first, min(first + TRIED, words.shape[0])):
                own = words[i]
                if not persists[i] or i == first:
                    before, rise = own, U(0)
                    continue
                size[XOR] += bytes_of(difference(XOR, own, before, rise, U(0)))
                size[DELTA] += bytes_of(difference(DELTA, own, before, rise, U(0)))
                size[LINEAR] += bytes_of(difference(LINEAR, own, before, rise, U(0)))
                if special >= ALONE:
                    hope = LINEAR if special == SPHERES and not known[i] else special
                    size[special] += bytes_of(difference(hope, own, before, rise, expected[i]))
                before, rise = own, own - before

    return inner(sizes)


def _make_pack(spec: Spec):
    difference, sizes = _make_difference(spec), _make_sizes(spec)

    def pack(words, rows, special, expected, size, packed):
        (persists, known), (chosen, planes) = rows, packed
        other_of = 0
        for j in range(words.shape[0]):
            size[:] = 0
            hopes = expected[other_of]
            if special[j] >= ALONE:
                other_of += 1
            sizes(words[j], rows, hopes, special[j], size)
            choice = XOR
            for other in range(DELTA, COUNT):
                if (other < ALONE or other == special[j]) and size[other] < size[choice]:
                    choice = other
            chosen[j] = choice
            before, rise = U(0), U(0)
            for i in range(words.shape[1]):
                own = words[j, i]
                if not persists[i]:
                    before, rise = U(0), U(0)
                guess = LINEAR if choice == SPHERES and not known[i] else choice
                word = difference(guess, own, before, rise, hopes[i])
                for k in range(8):
                    planes[7 - k, j, i] = np.uint8(word >> U(8 * k))
                # The first of a key has no rise: the second is expected to be as it was.
                before, rise = own, own - before if persists[i] else U(0)

    return inner(pack)


def _make_gather(spec: Spec):
    def gather(rows, order, columns, words):
        for i in range(U(len(order))):
            row = U(order[i])
            for j in range(U(len(columns))):
                words[j, i] = rows[row, U(columns[j])]

    return inner(gather)


@cache
def gather_columns():
    """Return `kernel(rows, order, columns, words)`: words[j, i] = rows[order[i], columns[j]].

    rows: (n, k), words: (m, n), uint64; order: (n,), columns: (m,), int64.
    """
    kernel = cached(_make_gather, Spec())
    words, ints = np.zeros((0, 0), np.uint64), np.zeros(0, np.int64)
    with compiling():
        kernel(words, ints, ints, words)
    return kernel


@cache
def pack_columns():
    """Return `kernel(words, rows, special, expected, size, packed)`.

    words: (m, n) of columns, rows in the order of their keys. rows: persists and known, (n,) bool,
    whether a row follows one of its key, and whether SPHERES expects it. special: (m,) predictor
    beside those that need no other column, 0 for none. expected: (k + 1, n) what the k of these
    expect, in their order; the last is not read.
    size: (COUNT,) to work in. packed: predictors (m,) and uint8 planes (8, m, n), to be filled.
    Words are uint64, else int64.
    """
    kernel = cached(_make_pack, Spec())
    words, ints = np.zeros((0, 0), np.uint64), np.zeros(0, np.int64)
    packed = ints, np.zeros((8, 0, 0), np.uint8)
    with compiling():  # here, and not in one of the threads that close chunks
        kernel(words, (np.zeros(0, np.bool_),) * 2, ints, words, ints, packed)
    return kernel
