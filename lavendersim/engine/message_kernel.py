"""The kernel that lays messages of a log out: rows of numbers into bytes, at slots of templates.

Compiled once, for logs of every form: what differs between forms (template, slots, columns) comes
as arrays. It releases the interpreter lock, so chunks are laid out beside the simulation. Indices
are unsigned: numba wraps signed ones, and bytes side by side are then stored one by one.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from .compile import compiling, inner
from .kernel_cache import cached
from .spec import Spec

U = np.uint64
OFFSET, COLUMN, WIDTH, IS_VARINT = U(0), U(1), U(2), U(3)  # of a slot
_ONE, _SEVEN, _EIGHT, _LOW, _MORE = U(1), U(7), U(8), U(0x7F), U(0x80)


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


def _put_varint(data, at, width, value):
    """Write a varint of fixed width: padded with continuation bits."""
    last = width - _ONE
    for k in range(last):
        data[at + k] = np.uint8(value >> (_SEVEN * k) & _LOW | _MORE)
    data[at + last] = np.uint8(value >> (_SEVEN * last) & _LOW)


def _make_fill(spec: Spec):
    put_word, put_varint = inner(_put_word), inner(_put_varint)

    def fill(data, starts, layout, words, heads):
        template, text, slots, head_slots, odd_slots = layout
        whole = U(len(text)) * _EIGHT
        for i in range(U(len(starts))):
            start = U(starts[i])
            for k in range(U(len(text))):
                put_word(data, start + k * _EIGHT, text[k])
            for k in range(whole, U(len(template))):
                data[start + k] = template[k]
            for s in range(U(len(slots))):
                put_word(data, start + slots[s, OFFSET], words[i, slots[s, COLUMN]])
            for s in range(U(len(head_slots))):
                put_word(data, start + head_slots[s, OFFSET], heads[i, head_slots[s, COLUMN]])
            for s in range(U(len(odd_slots))):
                at, width = start + odd_slots[s, OFFSET], odd_slots[s, WIDTH]
                word = heads[i, odd_slots[s, COLUMN]]
                if odd_slots[s, IS_VARINT] == _ONE:
                    put_varint(data, at, width, word)
                else:
                    for k in range(width):
                        data[at + k] = np.uint8(word >> (_EIGHT * k))

    return inner(fill)


@cache
def fill_messages():
    """Return `kernel(data, starts, (template, text, slots, head_slots, odd_slots), words, heads)`.

    It writes one message, or one row of one, per start; the caller guarantees room.
    data: bytes of a chunk. starts: (n,), where each goes. template: its bytes, slots among them.
    text: the same as words, as many as are whole: written as such, it takes a fifth of the time.
    words: (n, m), heads: (n, h), numbers bit for bit. slots, head_slots: (k, 2), byte in the
    template, and column of words or heads whose eight bytes go there. odd_slots: (k, 4), width [B]
    besides, and whether a varint of that width goes there, or as many low bytes. All but bytes are
    uint64.
    """
    kernel = cached(_make_fill, Spec())
    none, no_rows = np.zeros(0, np.uint8), np.zeros((0, 4), U)
    with compiling():  # here, and not in one of the threads that close chunks
        no_words = np.zeros(0, U)
        kernel(none, no_words, (none, no_words, no_rows, no_rows, no_rows), no_rows, no_rows)
    return kernel
