"""The byte layout of every message; writer and reader share it.

Every layout is a whole MCAP Message record (opcode, length, channel, sequence, log and publish
time, data), so a chunk is filled by copying rows. Slots: `sequence`, `clock` (log and publish
time), `seconds` and `nanos` (protobuf), and the columns under the names given below.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from mcap.opcode import Opcode

from lavendersim.trace.schema import Column
from lavendersim.trace.wire import FIXED64, LENGTH, VARINT, VARINT_WIDTH, Template, tag, varint

RECORD_HEADER = 9  # opcode and length
MESSAGE_HEADER = 22  # channel, sequence, log time, publish time
FIXED32 = 5  # protobuf wire type
POSE = 7  # x y z qw qx qy qz
VELOCITY = 6  # vx vy vz wx wy wz, behind a pose where they are logged

# channel of every topic; fixed, so that chunks of equal runs are equal
CHANNELS = {
    "/robot_description": 1,
    "/tf": 2,
    "/contacts": 3,
    "/step": 4,
    "/residuals": 5,
    "/plot/force": 6,
    "/plot/penetration": 7,
    "/plot/log10_residual": 8,
    "/contact_columns": 9,
    "/velocities": 10,
}


class PackedField(NamedTuple):
    """One field of a packed point: as foxglove.PackedElementField."""

    name: str
    offset: int
    type: int


def root_frame(bodies: Sequence[str]) -> str:
    """Return the name of the world frame: `world`, unless a body is called so."""
    name = "world"
    while name in bodies:
        name = "_" + name
    return name


def record(topic: str, body: Template, open_ended: bool = False) -> Template:
    """Return the Message record around `body`; open-ended bodies have a `length` slot."""
    layout = Template().constant(bytes([Opcode.MESSAGE]))
    if open_ended:
        layout.slot("length", 8)
    else:
        layout.constant(struct.pack("<Q", MESSAGE_HEADER + len(body)))
    layout.constant(struct.pack("<H", CHANNELS[topic]))
    layout.slot("sequence", 4).slot("clock", 8).slot("clock", 8)
    return layout.embed(body)


def step_layout(columns: Sequence[Column]) -> Template:
    """Return the layout of /step; slot `step` holds the columns in their order."""
    return _step_layout(tuple(columns))


@lru_cache(maxsize=64)
def _step_layout(columns: tuple[Column, ...]) -> Template:
    body = Template()
    for column in columns:
        body.word(column.number, "step")
    return record("/step", body)


def plot_layout(topic: str) -> Template:
    """Return the layout of a /plot topic: a Float64MultiArray of one value, slot `plot`.

    CDR, little endian; after its four bytes: no dimensions, no offset, one value, padding to 8.
    """
    head = bytes([0, 1, 0, 0]) + struct.pack("<IIII", 0, 0, 1, 0)
    return record(topic, Template().constant(head).slot("plot", 8))


def _doubles(names: int, slot: str) -> Template:
    body = Template()
    for number in range(1, names + 1):
        body.word(number, slot)
    return body


def transforms_layout(bodies: Sequence[str]) -> Template:
    """Return the layout of /tf; slot `pose` holds x y z qx qy qz qw of each body in turn."""
    return _transforms_layout(tuple(bodies))


@lru_cache(maxsize=64)
def _transforms_layout(bodies: tuple[str, ...]) -> Template:
    body, frame = Template(), root_frame(bodies)
    for name in bodies:
        one = Template().timestamp(1).string(2, frame).string(3, name)
        one.message(4, _doubles(3, "pose")).message(5, _doubles(4, "pose"))
        body.message(1, one)
    return record("/tf", body)


def velocities_layout(bodies: Sequence[str]) -> Template:
    """Return the layout of /velocities; slot `velocity` has vx vy vz wx wy wz of each in turn."""
    return _velocities_layout(tuple(bodies))


@lru_cache(maxsize=64)
def _velocities_layout(bodies: tuple[str, ...]) -> Template:
    body = Template().timestamp(1)
    for name in bodies:
        one = Template().string(1, name)
        one.message(2, _doubles(3, "velocity")).message(3, _doubles(3, "velocity"))
        body.message(2, one)
    return record("/velocities", body)


def residual_row_layout(columns: Sequence[Column]) -> Template:
    """Return the layout of one sweep in /residuals; slot `sweep` holds the columns."""
    row = Template()
    for column in columns:
        row.word(column.number, "sweep")
    return Template().message(2, row)


def residual_layout() -> Template:
    """Return the layout of /residuals before its sweeps; slot `step`."""
    return record("/residuals", Template().word(1, "step"), open_ended=True)


def bytes_field(number: int, length: int) -> bytes:
    """Return what stands before the bytes of a protobuf field of so many."""
    return tag(number, LENGTH) + varint(length)


def message_head(topic: str, sequence: int, clock: int, length: int) -> bytes:
    """Return what of a Message record stands before its data; clock: its time [ns]."""
    head = struct.pack("<HIQQ", CHANNELS[topic], sequence, clock, clock)
    return bytes([Opcode.MESSAGE]) + struct.pack("<Q", MESSAGE_HEADER + length) + head


@lru_cache(maxsize=64)
def contact_layout(fields: tuple[PackedField, ...], stride: int, frame: str) -> Template:
    """Return the layout of /contacts before its points; slots `length`, `data_length`."""
    identity = Template().message(1, _zeros(3))
    one = _zeros(3).constant(tag(4, FIXED64) + struct.pack("<d", 1.0))
    cloud = Template().timestamp(1).string(2, frame).message(3, identity.message(2, one))
    cloud.constant(tag(4, FIXED32) + struct.pack("<I", stride))
    for field in fields:
        entry = Template().string(1, field.name)
        entry.constant(tag(2, FIXED32) + struct.pack("<I", field.offset))
        entry.constant(tag(3, VARINT) + varint(field.type))
        cloud.message(5, entry)
    cloud.constant(tag(6, LENGTH)).slot("data_length", VARINT_WIDTH)
    return record("/contacts", cloud, open_ended=True)


def _zeros(count: int) -> Template:
    """Return explicit zero doubles: rerun takes an absent coordinate for an absent pose."""
    body = Template()
    for number in range(1, count + 1):
        body.constant(tag(number, FIXED64) + bytes(8))
    return body
