"""The kernel that lays contacts out as points for viewers: float32, cut, one behind the other.

Compiled once, for the contacts of all logs: which columns a point has comes as an array.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from .compile import compiling, inner
from .kernel_cache import cached
from .spec import Spec

U, HALF = np.uint64, np.uint32
POSITIONS = 3  # so many columns come first: they are on a grid, the others are cut


def _put_half(data, at, word):
    """Write four bytes, the lightest first."""
    data[at] = np.uint8(word)
    data[at + U(1)] = np.uint8(word >> HALF(8))
    data[at + U(2)] = np.uint8(word >> HALF(16))
    data[at + U(3)] = np.uint8(word >> HALF(24))


def _make_lay(spec: Spec):
    put_half = inner(_put_half)

    def lay(data, places, numbers, columns, choices, scratch):
        (starts, counts), (floats, words) = places, scratch
        grid, loaded_by, (kept, loaded, unloaded) = choices
        contact = 0
        for i in range(len(starts)):
            at = U(starts[i])
            for _ in range(counts[i]):
                row = numbers[contact]
                for k in range(len(columns)):
                    exact = row[columns[k]]
                    if k < POSITIONS and grid > 0.0:
                        exact = np.rint(exact / grid) * grid
                    floats[k] = np.float32(exact)
                for k in range(len(columns)):
                    put_half(data, at, words[k] if k < POSITIONS else words[k] & kept)
                    at += U(4)
                is_loaded = loaded_by < 0 or row[loaded_by] > 0.0
                put_half(data, at, loaded if is_loaded else unloaded)
                at += U(4)
                contact += 1

    return inner(lay)


@cache
def lay_points():
    """Return `kernel(data, (starts, counts), numbers, columns, (grid, loaded_by, masks), scratch)`.

    It writes the points of the contacts of each step, from its start on; the caller guarantees
    room. data: bytes. starts, counts: (n,) int64. numbers: (contacts, k) float64, by step.
    columns: of these, in the order of a point, positions first. grid: [m], 0 for none. loaded_by:
    the column that is above 0 where a contact is loaded, -1: all are. masks: of three uint32, what
    is kept of a float32 that is no position, and the colours of contacts that are loaded or not.
    scratch: float32 (k,) and the same memory as uint32.
    """
    kernel = cached(_make_lay, Spec())
    ints, floats = np.zeros(0, np.int64), np.zeros(0, np.float32)
    with compiling():  # here, and not in one of the threads that close chunks
        kernel(
            np.zeros(0, np.uint8),
            (ints, ints),
            np.zeros((0, 0)),
            ints,
            (0.0, -1, (HALF(0),) * 3),
            (floats, floats.view(HALF)),
        )
    return kernel
