"""Templates of messages are protobuf as its own library reads it, and their slots are apart."""

from __future__ import annotations

import numpy as np
import pytest
from google.protobuf.internal.decoder import _DecodeVarint
from google.protobuf.internal.encoder import _VarintBytes
from google.protobuf.timestamp_pb2 import Timestamp
from google.protobuf.wrappers_pb2 import DoubleValue

from lavendersim.trace.wire import Template, gather, padded_varints, varint

EDGES = [0, 1, 127, 128, 16383, 16384, 2**31, 2**32, 2**35 - 1]


@pytest.mark.parametrize("value", [*EDGES, 2**63, 2**64 - 1])
def test_a_varint_is_the_shortest_that_protobuf_writes(value: int) -> None:
    assert varint(value) == _VarintBytes(value)


def test_varints_of_one_width_are_read_as_their_values() -> None:
    rows = padded_varints(np.array(EDGES))
    for row, value in zip(rows, EDGES, strict=True):
        assert _DecodeVarint(row.tobytes(), 0) == (value, rows.shape[1])


def test_filled_times_are_read_by_protobuf() -> None:
    """A Timestamp is field 1 of its own kind: seconds and nanoseconds, both padded."""
    stamp = Template().timestamp(1)
    rows = stamp.rows(len(EDGES))
    seconds, nanos = np.array(EDGES), np.arange(len(EDGES)) * 111_111_111
    for name, values in (("seconds", seconds), ("nanos", nanos)):
        size, (offset,) = stamp.slots[name]
        rows[:, offset : offset + size] = padded_varints(values)
    for row, second, nano in zip(rows, seconds, nanos, strict=True):
        data = row.tobytes()
        length, start = _DecodeVarint(data, 1)
        assert start + length == len(data)
        read = Timestamp.FromString(data[start:])
        assert (read.seconds, read.nanos) == (second, nano)


@pytest.mark.parametrize("number", [0.0, -0.0, 1.5e-300, float("inf")])
def test_a_word_is_read_as_a_double_to_its_last_bit(number: float) -> None:
    word = Template().word(1, "value")
    rows = word.rows(1)
    size, (offset,) = word.slots["value"]
    rows[0, offset : offset + size] = np.frombuffer(np.float64(number).tobytes(), np.uint8)
    read = DoubleValue.FromString(rows.tobytes()).value
    assert np.float64(read).tobytes() == np.float64(number).tobytes()


def two_points() -> Template:
    point = Template().word(1, "x").word(2, "y")
    return Template().string(3, "half").message(4, point).message(4, point)


def test_slots_of_embedded_messages_stand_where_their_bytes_are() -> None:
    """Bytes that no slot covers are all that a template fixes: change each, one at a time."""
    template = two_points()
    row = template.rows(1)
    covered = {
        place
        for size, offsets in template.slots.values()
        for offset in offsets
        for place in range(offset, offset + size)
    }
    assert len(covered) == 4 * 8  # two points of two numbers: no slot lies on another
    for place in range(len(template)):
        changed = row.copy()
        changed[0, place] ^= 0x40
        assert template.matches(changed) == (place in covered)


def test_what_was_filled_in_is_taken_out() -> None:
    template = two_points()
    rows = template.rows(5)
    numbers = np.random.default_rng(2).normal(size=(5, 2))
    size, offsets = template.slots["y"]
    for column, offset in enumerate(offsets):
        rows[:, offset : offset + size] = numbers[:, column].copy().view(np.uint8).reshape(5, 8)
    taken = np.ascontiguousarray(template.take(rows, "y")).view(np.float64)
    np.testing.assert_array_equal(taken.reshape(5, 2), numbers)
    assert template.matches(rows)


def test_a_slot_has_one_size() -> None:
    with pytest.raises(ValueError, match="two sizes"):
        Template().slot("x", 8).slot("x", 4)


def test_gathering_gives_the_bytes_at_each_offset() -> None:
    data = np.random.default_rng(3).integers(0, 256, 40, dtype=np.uint8)
    offsets = np.array([30, 0, 7, 37])  # the last ends where the data ends
    expected = np.stack([data[at : at + 3] for at in offsets])
    np.testing.assert_array_equal(gather(data, offsets, 3), expected)
    with pytest.raises(IndexError):
        gather(data, np.array([38]), 3)
