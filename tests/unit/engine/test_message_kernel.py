"""Messages laid out by the kernel are those that Python's struct makes, byte by byte."""

from __future__ import annotations

import struct

import numpy as np

from lavendersim.engine.message_kernel import fill_messages

U = np.uint64


def varint(value: int, width: int) -> bytes:
    """Return a varint of so many bytes: seven bits each, all but the last with the high bit set."""
    return bytes((value >> (7 * k)) & 0x7F | (0x80 if k < width - 1 else 0) for k in range(width))


def test_slots_hold_their_numbers_and_all_else_is_the_template(rng) -> None:
    """Two words at 3 and 20, a head at 12, a varint of 3 bytes at 30, two low bytes at 35.

    The last three bytes make no whole word.
    """
    template = rng.integers(0, 256, 43).astype(np.uint8)
    text = template[:40].view(U)
    words = rng.integers(0, 2**63, (5, 4), dtype=U)
    heads = np.column_stack(
        [rng.integers(0, 2**63, 5, dtype=U), rng.integers(0, 2**21, 5, dtype=U),
         rng.integers(0, 2**16, 5, dtype=U)]
    )  # fmt: skip
    slots, head_slots = np.array([[3, 2], [20, 0]], U), np.array([[12, 0]], U)
    odd_slots = np.array([[30, 1, 3, 1], [35, 2, 2, 0]], U)
    starts = np.array([100, 7, 300, 50, 200], U)
    data = np.full(400, 0xEE, np.uint8)
    fill_messages()(data, starts, (template, text, slots, head_slots, odd_slots), words, heads)
    expected = bytearray(b"\xee" * 400)
    for i, start in enumerate(starts.tolist()):
        message = bytearray(template.tobytes())
        message[3:11] = struct.pack("<Q", words[i, 2])
        message[20:28] = struct.pack("<Q", words[i, 0])
        message[12:20] = struct.pack("<Q", heads[i, 0])
        message[30:33] = varint(int(heads[i, 1]), 3)
        message[35:37] = struct.pack("<H", heads[i, 2])
        expected[start : start + 43] = message
    assert data.tobytes() == bytes(expected)
