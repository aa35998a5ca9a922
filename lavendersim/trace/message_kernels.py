"""Kernels that lay messages out: rows of numbers into bytes, where templates have their slots.

Compiled once, for logs of every form: what differs between forms (template, slots, columns) comes
as arrays. They release the interpreter lock, so chunks are laid out beside the simulation. Indices
are unsigned: numba wraps signed ones, and bytes side by side are then stored one by one.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from lavendersim.engine.compile import compiling, inner
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.spec import Spec
from lavendersim.trace.wire import NANOSECONDS, TIMESTAMP_WIDTH, VARINT_WIDTH

U = np.uint64
NANOS_TAG = U(0x10)  # field 2, a varint
_LAST = U(VARINT_WIDTH - 1)


def _put_word(data, at, word):
    """Write eight bytes, the lightest first."""
    data[at] = np.uint8(word)
    data[at + U(1)] = np.uint8(word >> U(8))
    data[at + U(2)] = np.uint8(word >> U(16))
    data[at + U(3)] = np.uint8(word >> U(24))
    data[at + U(4)] = np.uint8(word >> U(32))
    data[at + U(5)] = np.uint8(word >> U(40))
    data[at + U(6)] = np.uint8(word >> U(48))
    data[at + U(7)] = np.uint8(word >> U(56))


def _put_varint(data, at, value):
    """Write a varint of fixed width: padded with continuation bits."""
    for k in range(_LAST):
        data[at + k] = np.uint8(value >> (U(7) * k) & U(0x7F) | U(0x80))
    data[at + _LAST] = np.uint8(value >> (U(7) * _LAST) & U(0x7F))


def _make_fill(spec: Spec) -> Any:
    put_word, put_varint = inner(_put_word), inner(_put_varint)
    timestamp, varint, second = U(TIMESTAMP_WIDTH), U(VARINT_WIDTH), U(NANOSECONDS)

    def fill(data, starts, template, slots, words, head_slots, heads, odd_slots):
        for i in range(U(len(starts))):
            start = U(starts[i])
            for k in range(U(len(template))):
                data[start + k] = template[k]
            for s in range(U(len(slots))):
                put_word(data, start + slots[s, U(0)], words[i, slots[s, U(1)]])
            for s in range(U(len(head_slots))):
                put_word(data, start + head_slots[s, U(0)], heads[i, head_slots[s, U(1)]])
            for s in range(U(len(odd_slots))):
                at, width = start + odd_slots[s, U(0)], odd_slots[s, U(2)]
                word = heads[i, odd_slots[s, U(1)]]
                if width == timestamp:
                    put_varint(data, at, word // second)
                    data[at + varint] = np.uint8(NANOS_TAG)
                    put_varint(data, at + varint + U(1), word % second)
                elif width == varint:
                    put_varint(data, at, word)
                else:
                    for k in range(width):
                        data[at + k] = np.uint8(word >> (U(8) * k))

    return inner(fill)


@cache
def fill() -> Any:
    """Return `kernel(data, starts, template, slots, words, head_slots, heads, odd_slots)`.

    It writes one message, or one row of one, per start; the caller guarantees room.
    data: bytes of a chunk. starts: (n,), where each goes. template: its bytes, slots among them.
    words: (n, m), heads: (n, h), numbers bit for bit. slots, head_slots: (k, 2), byte in the
    template, and column of words or heads whose eight bytes go there. odd_slots: (k, 3), width [B]
    besides, and how many low bytes of a head go there, or as a varint or a Timestamp of that width
    (whole nanoseconds). All but bytes are uint64.
    """
    kernel = cached(_make_fill, Spec())
    none, no_rows = np.zeros(0, np.uint8), np.zeros((0, 3), U)
    with compiling():  # here, and not in one of the threads that close chunks
        kernel(none, np.zeros(0, U), none, no_rows, no_rows, no_rows, no_rows, no_rows)
    return kernel
