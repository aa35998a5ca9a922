"""The columns of checked chunks: the mirror of `encode`, by the same layouts.

Columns are those the file names: the fields of its lavender.Step and lavender.Residuals
descriptors, and the `fields` of its PointCloud messages. A file whose messages have those columns
in another layout than lavender writes is refused, not misread.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache, partial
from typing import Any, NamedTuple

import numpy as np
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.records import Schema
from numpy.typing import NDArray

from lavendersim.clock import Clock
from lavendersim.record_tables import joined
from lavendersim.trace import layout
from lavendersim.trace.contact_columns import DERIVED, Packed, unpack
from lavendersim.trace.index import ChunkContent
from lavendersim.trace.layout import PackedField
from lavendersim.trace.limits import check_counts
from lavendersim.trace.schema import FORMER_NAMES, HIGH_WORD, KINDS, NUMERIC_TYPES, Column
from lavendersim.trace.sphere_contacts import POSITION, Floats, Starts
from lavendersim.trace.wire import (
    NANOSECONDS,
    Bytes,
    Rows,
    Template,
    gather,
    padded_varints,
    rows_behind,
)

Table = NDArray[Any]
MOST_STRIDE = 1 << 16  # bytes of a point: 8,000 columns


def columns_in(schema: Schema, message: str) -> tuple[Column, ...]:
    """Return the columns a descriptor names, by the names that they have now.

    ValueError for a type that is no column's.
    """
    files = descriptor_pb2.FileDescriptorSet.FromString(schema.data).file
    (found,) = (m for file in files for m in file.message_type if m.name == message)
    for field in found.field:
        if field.type not in KINDS:
            raise ValueError(f"field {field.name!r} of {message} has another type than lavender's")
    return tuple(
        Column(FORMER_NAMES.get(f.name, f.name), KINDS[f.type], f.number, "") for f in found.field
    )


def _table(columns: Sequence[tuple[str, str]], count: int) -> Table:
    return np.empty(count, [(name, "=" + kind) for name, kind in columns])


def join(parts: Iterable[Table], columns: Sequence[tuple[str, str]]) -> Table:
    """Return the parts of a table as one."""
    return joined([_table(columns, 0), *parts])


def _matching(template: Template, data: Bytes, offsets: Rows) -> Bytes:
    """Return the rows at those offsets. ValueError when they are not of that layout."""
    rows = gather(data, offsets.astype(np.int64), len(template))
    if not template.matches(rows):
        raise ValueError("messages have another layout than lavender's")
    return rows


def seconds(time_ns: Rows) -> NDArray[np.float64]:
    """Return times [s]."""
    times: NDArray[np.float64] = time_ns.astype(np.float64) / NANOSECONDS
    return times


def step_columns(columns: Sequence[Column]) -> list[tuple[str, str]]:
    """Return the names and kinds of the step table: the file's, and `time` [s]."""
    return [*((c.name, c.kind) for c in columns), ("time", "f8")]


def decode_steps(chunk: ChunkContent, columns: Sequence[Column]) -> Table:
    """Return the step table of a light chunk."""
    entries = chunk.messages[layout.CHANNELS["/step"]]
    template = layout.step_layout(columns)
    words = template.take(_matching(template, chunk.data, entries["offset"]), "step")
    table = _table(step_columns(columns), len(entries))
    for index, column in enumerate(columns):
        table[column.name] = _column(words, index, column.kind)
    table["time"] = seconds(entries["time"])
    return table


def _column(words: Rows, index: int, kind: str) -> Rows:
    return np.ascontiguousarray(words[:, index]).view("<" + kind)


def residual_columns(columns: Sequence[Column]) -> list[tuple[str, str]]:
    """Return the names and kinds of the residual table."""
    return [("step", "i8"), *((c.name, c.kind) for c in columns)]


def decode_residuals(chunk: ChunkContent, columns: Sequence[Column]) -> Table:
    """Return the residual table of a light chunk."""
    offsets = chunk.messages[layout.CHANNELS["/residuals"]]["offset"].astype(np.int64)
    head, tail = layout.residual_layout(), layout.residual_row_layout(columns)
    rows = _matching(head, chunk.data, offsets)
    counts = _counts(head, rows, len(tail))
    sweeps = _matching(tail, chunk.data, rows_behind(offsets + len(head), counts, len(tail)))
    words = tail.take(sweeps, "sweep")
    table = _table(residual_columns(columns), len(sweeps))
    table["step"] = np.repeat(_column(head.take(rows, "step"), 0, "i8"), counts)
    for index, column in enumerate(columns):
        table[column.name] = _column(words, index, column.kind)
    return table


def decode_poses(
    chunk: ChunkContent, template: Template, bodies: int
) -> tuple[Rows, NDArray[np.float64]]:
    """Return steps (n,) and poses (n, bodies, 7) of a chunk; template: the layout of /tf."""
    steps, numbers = _of_bodies(chunk, "/tf", template, "pose", (bodies, layout.POSE))
    return steps, numbers[:, :, [0, 1, 2, 6, 3, 4, 5]].astype(np.float64)


def decode_velocities(
    chunk: ChunkContent, template: Template, bodies: int
) -> tuple[Rows, NDArray[np.float64]]:
    """Return steps (n,) and velocities (n, bodies, 6) of a chunk; template: that of their topic."""
    form = bodies, layout.VELOCITY
    steps, numbers = _of_bodies(chunk, "/velocities", template, "velocity", form)
    return steps, numbers.astype(np.float64)


def _of_bodies(
    chunk: ChunkContent, topic: str, template: Template, slot: str, form: tuple[int, int]
) -> tuple[Rows, Rows]:
    """Return steps (n,) and the numbers of their bodies (n, *form) of a topic in a chunk."""
    rows = _matching(template, chunk.data, chunk.messages[layout.CHANNELS[topic]]["offset"])
    shape = (len(rows), *form)
    if not form[0]:  # a message of no bodies has no such slot
        return _sequence(template, rows), np.empty(shape)
    words = np.ascontiguousarray(template.take(rows, slot)).view("<f8").reshape(shape)
    return _sequence(template, rows), words


@lru_cache(maxsize=8)
def message_class(name: str, descriptors: bytes) -> Any:
    """Return the class of a protobuf message by its descriptors."""
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(descriptors).file:
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))


def packed_fields(schema: Schema, chunk: ChunkContent) -> tuple[tuple[PackedField, ...], int]:
    """Return the fields and the stride [B] that the first PointCloud of a chunk gives."""
    cloud = message_class(schema.name, schema.data)()
    offset = chunk.messages[layout.CHANNELS["/contacts"]]["offset"][0]
    cloud.ParseFromString(body_of(chunk, int(offset)))
    fields = tuple(PackedField(f.name, f.offset, f.type) for f in cloud.fields)
    if not 0 < cloud.point_stride <= MOST_STRIDE:
        raise ValueError(f"points of {cloud.point_stride} bytes")
    return fields, cloud.point_stride


@lru_cache(maxsize=64)
def contact_row(fields: tuple[PackedField, ...], stride: int) -> np.dtype[Any]:
    """Return the row of the contact table: a point as it stands.

    `step` and `time` stand where a point has no column; its bytes are colours, for viewers only.
    ValueError when a field does not fit.
    """
    sizes = {number: int(code[1]) for code, number in NUMERIC_TYPES.items()}
    if any(field.offset + sizes[field.type] > stride for field in fields):
        raise ValueError("a field of a point cloud stands outside its points")
    places = {field.name: field.offset for field in fields}
    columns: dict[str, tuple[str, int]] = {}
    for field in fields:
        if field.type == NUMERIC_TYPES["f8"]:
            columns[field.name] = "<f8", field.offset
        elif places.get(field.name + HIGH_WORD) == field.offset + 4:
            columns[field.name] = "<i8", field.offset
    taken = {offset for _, offset in columns.values()}
    free = (offset for offset in itertools.count(0, 8) if offset not in taken)
    row = {"step": ("=i8", next(free)), **columns, "time": ("=f8", next(free))}
    return np.dtype(
        {
            "names": list(row),
            "formats": [kind for kind, _ in row.values()],
            "offsets": [offset for _, offset in row.values()],
            "itemsize": max(stride, *(offset + 8 for _, offset in row.values())),
        }
    )


def decode_contacts(
    chunk: ChunkContent, fields: Sequence[PackedField], stride: int, frame: str
) -> Table:
    """Return the contact table of a chunk of points."""
    entries = chunk.messages[layout.CHANNELS["/contacts"]]
    head = layout.contact_layout(tuple(fields), stride, frame)
    offsets = entries["offset"].astype(np.int64)
    rows = _matching(head, chunk.data, offsets)
    counts = _counts(head, rows, stride)
    written = np.ascontiguousarray(head.take(rows, "data_length")[:, 0]).view(np.uint8)
    if not np.array_equal(written.reshape(len(rows), -1), padded_varints(counts * stride)):
        raise ValueError("a point cloud contradicts its length")
    row = contact_row(tuple(fields), stride)
    data = np.empty((counts.sum(), row.itemsize), np.uint8)
    data[:, :stride] = gather(chunk.data, rows_behind(offsets + len(head), counts, stride), stride)
    table: Table = data.view(row)[:, 0]
    table["step"] = np.repeat(_sequence(head, rows), counts)
    table["time"] = np.repeat(seconds(entries["time"]), counts)
    return table


class AroundContacts(NamedTuple):
    """What contacts of a log are given back by, beside their chunk."""

    clock: Clock
    positions: Callable[[Rows], Floats]  # of all bodies after some steps (n, bodies, 3) [m]


def decode_columns(
    chunk: ChunkContent, schema: Schema, derived: tuple[str, ...], log: AroundContacts
) -> Table:
    """Return the contact table of a chunk of columns; log: what else of it that may take."""
    entries = chunk.messages[layout.CHANNELS["/contact_columns"]]
    tables = []
    for offset in entries["offset"].astype(np.int64):
        message = message_class(schema.name, schema.data)()
        message.ParseFromString(body_of(chunk, int(offset)))
        fields = message.DESCRIPTOR.fields_by_name  # older logs lack some
        numbers = (message.steps, message.times, message.counts)
        steps, times, counts = (np.frombuffer(one, "<i8") for one in numbers)
        names = tuple(message.names)
        columns = [("step", "i8"), *zip(names, message.kinds, strict=True)]
        check_counts(counts, len(names), len(message.keys) + len(message.planes))
        table = _table([*columns, *((name, "f8") for name in (*derived, "time"))], counts.sum())
        packed = Packed(*(getattr(message, name) for name in Packed._fields if name in fields))
        unpack(packed, names, table, partial(_starts, log, steps, counts))
        table["step"] = np.repeat(steps, counts)
        table["time"] = np.repeat(seconds(times), counts)
        tables.append(_derived(table, derived, log.clock))
    return joined(tables)


def _starts(log: AroundContacts, steps: Rows, counts: Rows, bodies: Floats) -> Starts:
    """Return where bodies are at the start of each of some steps: where they were before it."""
    positions = bodies[None, :, POSITION]
    if len(steps) > 1:
        positions = np.concatenate([positions, log.positions(steps[:-1])])
    return Starts(bodies, positions, np.repeat(np.arange(len(steps)), counts))


def _derived(table: Table, derived: tuple[str, ...], clock: Clock) -> Table:
    """Fill the columns that follow from others."""
    timesteps = clock.lengths(table["step"]) if derived else None
    with np.errstate(all="ignore"):  # what is not finite stays so, as in the kernel
        for name in derived:
            table[name] = DERIVED[name].value(table, timesteps)
    return table


def body_of(chunk: ChunkContent, offset: int) -> bytes:
    """Return the data of the message whose record stands there."""
    length = int(gather(chunk.data, np.array([offset + 1]), 8).view("<u8")[0, 0])
    begin = offset + layout.RECORD_HEADER + layout.MESSAGE_HEADER
    return chunk.data[begin : offset + layout.RECORD_HEADER + length].tobytes()


def _sequence(template: Template, rows: Bytes) -> Rows:
    return _column(template.take(rows, "sequence"), 0, "u4").astype(np.int64)


def _counts(head: Template, rows: Bytes, size: int) -> Rows:
    """Return how many rows follow each head. ValueError when they do not fill the record."""
    length = _column(head.take(rows, "length"), 0, "u8").astype(np.int64)
    tail = length + layout.RECORD_HEADER - len(head)
    if np.any(tail < 0) or np.any(tail % size):
        raise ValueError("messages have another layout than lavender's")
    return tail // size
