"""Layouts of messages, filled by hand and read by protobuf and MCAP's own record format."""

from __future__ import annotations

import struct

import pytest

from lavendersim.trace.layout import (
    CHANNELS,
    MESSAGE_HEADER,
    RECORD_HEADER,
    bytes_field,
    message_head,
    plot_layout,
    record,
    root_frame,
    step_layout,
    transforms_layout,
)
from lavendersim.trace.schema import STEP_COLUMNS
from lavendersim.trace.wire import Template


def test_the_world_is_called_so_unless_a_body_is() -> None:
    assert root_frame(["ball"]) == "world"
    assert root_frame(["world", "_world"]) == "__world"


def test_a_record_says_its_length_and_channel() -> None:
    made = record("/step", Template().constant(b"body"))
    opcode, length, channel = struct.unpack_from("<BQH", made.data)
    assert (opcode, length, channel) == (5, MESSAGE_HEADER + 4, CHANNELS["/step"])
    assert len(made) == RECORD_HEADER + MESSAGE_HEADER + 4
    assert made.slots == {"sequence": (4, [11]), "clock": (8, [15, 23])}


def test_an_open_ended_record_leaves_its_length_to_be_filled() -> None:
    made = record("/residuals", Template(), open_ended=True)
    assert made.slots["length"] == (8, [1])


def test_the_head_of_a_message_is_the_record_filled() -> None:
    filled = bytearray(record("/step", Template().constant(b"body")).data)
    struct.pack_into("<IQQ", filled, 11, 7, 99, 99)
    assert bytes(filled) == message_head("/step", 7, 99, 4) + b"body"


def test_a_step_has_a_slot_for_each_column_and_a_pose_seven_a_body() -> None:
    width, places = step_layout(STEP_COLUMNS).slots["step"]
    assert (width, len(places)) == (8, len(STEP_COLUMNS))
    assert len(transforms_layout(["a", "b"]).slots["pose"][1]) == 14
    assert transforms_layout(["a"]) is transforms_layout(("a",))  # made once


def test_a_plotted_number_is_cdr_of_one_value() -> None:
    body = plot_layout("/plot/force").data[RECORD_HEADER + MESSAGE_HEADER :]
    # header, no dimensions, offset 0, one value (padded to 8 behind the header), the value
    assert body == struct.pack("<4BIIII", 0, 1, 0, 0, 0, 0, 1, 0) + bytes(8)


@pytest.mark.parametrize("length", [0, 127, 128, 100_000])
def test_bytes_stand_behind_tag_and_length(length: int) -> None:
    head = bytes_field(3, length)
    assert head[0] == 3 << 3 | 2
    read = sum((byte & 0x7F) << (7 * k) for k, byte in enumerate(head[1:]))
    assert read == length
