"""The writer of logs: blocks of steps into the chunks of an MCAP file.

Steps are cut into groups, and each group is two chunks, bulk then light; a log without poses and
contacts has light ones only. A group closes with the
step that fills either stream, so where it closes depends on the steps alone, never on how they
came in or on a clock: equal runs give equal bytes. Bulk goes first: where a light chunk is whole,
everything before it is, and a killed run is readable up to its last light chunk.
"""

from __future__ import annotations

import json
import os
from collections import deque
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from mcap.records import Channel, Schema
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.trace import descriptors, layout
from lavendersim.trace.container import (
    INDEX_ENTRY,
    Closed,
    Container,
    FileIndex,
    Messages,
    Registered,
    closed,
)
from lavendersim.trace.encode import Block, Encoded, Encoder
from lavendersim.trace.schema import (
    CONTACT_COLUMNS,
    FORMAT,
    MULTI_ARRAY_DEFINITION,
    STRING_DEFINITION,
    Column,
)
from lavendersim.trace.urdf import robot_description
from lavendersim.trace.wire import Template

# Small, so that a killed run loses little and a plot of the force reads little.
LIGHT_BYTES = 128 * 1024
# Large enough to compress well, small enough that a viewer can hold a few.
BULK_BYTES = 1024 * 1024

# Threads that compress chunks beside the simulation, for all logs that this process writes, and
# how many chunks of a log may wait for them: that bounds its memory.
COMPRESSORS: Final = min(4, os.cpu_count() or 1)
MOST_WAITING: Final = 2 * COMPRESSORS
_threads = ThreadPoolExecutor(COMPRESSORS, "trace")
# Of a log up to this size [byte] the chunks are kept, so that who wrote it reads them from memory.
KEPT_BYTES: Final = 256 * 1024 * 1024

AS_WRITTEN, RESOLVED = "config.yaml", "resolved.json"  # attachments
DESCRIPTION, ENDING = "trace", "lavender"  # metadata written first and last
ABSENT = "absent"  # of the description: topic -> why the log does without it
TIMESTEP_CHANGES = "timestep_changes"  # and [steps done, timestep] of each; where there are any


class _Stream:
    """The open chunk of one stream: pieces of encoded blocks, and where their messages stand."""

    def __init__(self, prologue: bytes) -> None:
        self.size = 0  # message bytes; the prologue does not count
        self._pieces = [prologue]
        self._entries: dict[int, list[Any]] = {}

    def take(self, encoded: Encoded, times: Any, first: int, last: int) -> None:
        """Append the steps first..last of an encoded block."""
        begin, end = int(encoded.step_start[first]), int(encoded.step_start[last])
        shift = len(self._pieces[0]) + self.size - begin
        for channel, (rows, offsets) in encoded.messages.items():
            low, high = np.searchsorted(rows, (first, last))
            entries = np.empty(high - low, INDEX_ENTRY)
            entries["time"] = times[rows[low:high]]
            entries["offset"] = offsets[low:high] + shift
            self._entries.setdefault(channel, []).append(entries)
        self._pieces.append(encoded.data[begin:end].tobytes())
        self.size += end - begin

    def close(self) -> Closed:
        """Return the chunk; may be called from any thread."""
        entries = sorted(self._entries.items())
        messages = [Messages(channel, np.concatenate(parts)) for channel, parts in entries]
        return closed(b"".join(self._pieces), messages)


class _Form(NamedTuple):
    """What logs of the same bodies, topics and columns have in common."""

    encoder: Encoder
    light: Registered
    bulk: Registered


class Written(NamedTuple):
    """A log that was just written, for who reads it in the same process."""

    path: Path
    entries: FileIndex
    metadata: dict[str, dict[str, str]]
    as_written: str
    config: CellConfig
    chunks: list[Closed] | None  # None: too much to keep, they are read from the file


class TraceWriter:
    """Writes the log of one run; without `close` the file is a killed run, recoverable."""

    def __init__(
        self,
        path: str | Path,
        config: CellConfig,
        as_written: str,
        metadata: Mapping[str, Mapping[str, str]],
        absent: Mapping[str, str] | None = None,
    ) -> None:
        """Open the file. absent: the topics that this log does without, each with the reason."""
        absent = dict(absent or {})
        if unknown := absent.keys() - layout.CHANNELS.keys():
            raise ValueError(f"no topics of a log: {sorted(unknown)}")
        self._topics = layout.CHANNELS.keys() - absent.keys()
        self._path, self._config, self._as_written = Path(path), config, as_written
        self._bodies = config.scene.bodies
        clock = config.clock
        self._encoder: Encoder | None = None
        self._last_step = -1
        self._container = Container(self._path)
        self._container.attach(AS_WRITTEN, "application/yaml", as_written.encode())
        self._container.attach(RESOLVED, "application/json", config.as_json().encode())
        self._metadata: dict[str, dict[str, str]] = {}
        description = {
            "format": FORMAT,
            "bodies": json.dumps(list(self._bodies)),
            "timestep": str(clock.timestep),
            ABSENT: json.dumps(absent, sort_keys=True),
        }
        if clock.changes:
            changes = [[done, str(timestep)] for done, timestep in clock.changes]
            description[TIMESTEP_CHANGES] = json.dumps(changes)
        self._describe(DESCRIPTION, description)
        for name, values in metadata.items():
            if name in (DESCRIPTION, ENDING):
                raise ValueError(f"metadata may not be called {name!r}")
            self._describe(name, values)
        self._light, self._bulk = _Stream(b""), _Stream(b"")
        self._closing: deque[Future[Closed]] = deque()  # in the order of the file
        self._kept: list[Closed] | None = []
        self._kept_bytes = 0

    def append(self, block: Block) -> None:
        """Write a block of steps; its arrays are free again on return.

        ValueError when it contradicts itself or the blocks before.
        """
        step = block.step
        if not len(step):
            return
        order = np.concatenate([[self._last_step], step["step"]])
        if np.any(np.diff(order) <= 0) or step["step"][-1] >= 2**32:
            raise ValueError("steps do not ascend, or exceed 32 bits")
        if "/step" not in self._topics:
            raise ValueError("a log without /step takes no steps")
        if self._encoder is None:
            self._begin(block)
        assert self._encoder is not None
        light, bulk = self._encoder.encode(block)
        times = step["time_ns"].astype(np.uint64)
        self._last_step = int(step["step"][-1])
        first = 0
        while first < len(step):
            last = min(
                _end_of_group(light, first, LIGHT_BYTES - self._light.size),
                _end_of_group(bulk, first, BULK_BYTES - self._bulk.size),
            )
            self._light.take(light, times, first, min(last, len(step)))
            self._bulk.take(bulk, times, first, min(last, len(step)))
            if last <= len(step):
                self._close_group()
            first = last

    def close(self, status: str) -> Written:
        """End the log; status is `complete`, or why the run ended early."""
        for future in self._closing:
            self._write(future.result())
        self._closing.clear()
        for stream in (self._bulk, self._light):
            if stream.size:
                self._write(stream.close())
        self._describe(ENDING, {"status": status})
        self._container.finish()
        index, kept = self._container.index, self._kept
        return Written(self._path, index, self._metadata, self._as_written, self._config, kept)

    def abandon(self) -> None:
        """Let the file go as a killed run would leave it."""
        for future in self._closing:
            self._write(future.result())
        self._container.abandon()

    def _describe(self, name: str, values: Mapping[str, str]) -> None:
        self._container.describe(name, values)
        self._metadata[name] = dict(values)

    def _begin(self, block: Block) -> None:
        """Write the scene's geometry and open the streams: the columns are known now."""
        columns = block.step.dtype, block.contact.dtype, block.residual.dtype
        form = _form(tuple(self._bodies), columns, frozenset(self._topics))
        self._encoder = form.encoder
        if "/robot_description" in self._topics:
            self._describe_geometry(block.pose[0].astype(np.float64))
        self._container.register(form.bulk)
        self._container.register(form.light)
        self._bulk, self._light = _Stream(form.bulk.data), _Stream(form.light.data)

    def _describe_geometry(self, poses: NDArray[np.float64]) -> None:
        """Write the chunk of /robot_description; poses: of the initial state (bodies, 7)."""
        self._container.register(_description_records())
        self._write(_description(robot_description(self._bodies, poses)))

    def _close_group(self) -> None:
        """Hand the open chunks to the compressing threads, and write those that are done."""
        for stream in (self._bulk, self._light):
            if stream.size:
                self._closing.append(_threads.submit(stream.close))
        self._bulk, self._light = _Stream(b""), _Stream(b"")
        while self._closing and (self._closing[0].done() or len(self._closing) > MOST_WAITING):
            self._write(self._closing.popleft().result())

    def _write(self, one: Closed) -> None:
        self._container.write_chunk(one)
        self._kept_bytes += len(one.payload)
        if self._kept_bytes > KEPT_BYTES:
            self._kept = None
        if self._kept is not None:
            self._kept.append(one)


@lru_cache(maxsize=64)
def _form(
    bodies: tuple[str, ...], columns: tuple[np.dtype[Any], ...], topics: frozenset[str]
) -> _Form:
    """Return the form of logs with these bodies, columns of step, contact, residual, and topics."""
    encoder = Encoder(bodies, columns, topics)
    schemas, channels = [], []
    if "/tf" in topics:
        form = descriptors.transforms_schema()
        schemas.append(Schema(2, form, "protobuf", "foxglove.FrameTransforms"))
        channels.append(_channel("/tf", 2, "protobuf"))
    if "/contacts" in topics:
        form = descriptors.point_cloud_schema()
        schemas.append(Schema(3, form, "protobuf", "foxglove.PointCloud"))
        names = [field.name for field in encoder.fields]
        meanings = {name: CONTACT_COLUMNS[name] for name in names if name in CONTACT_COLUMNS}
        channels.append(_channel("/contacts", 3, "protobuf", meanings))
    bulk = Registered.of(schemas, channels)

    step, sweep = encoder.step_columns, encoder.residual_columns
    schemas = [Schema(4, descriptors.step_schema(step), "protobuf", "lavender.Step")]
    channels = [_channel("/step", 4, "protobuf", _meanings(step))]
    if "/residuals" in topics:
        form = descriptors.residuals_schema(sweep)
        schemas.append(Schema(5, form, "protobuf", "lavender.Residuals"))
        channels.append(_channel("/residuals", 5, "protobuf", _meanings(sweep)))
    if encoder.plots:
        form = MULTI_ARRAY_DEFINITION.encode()
        schemas.append(Schema(6, form, "ros2msg", "std_msgs/msg/Float64MultiArray"))
        channels += [_channel(topic, 6, "cdr") for topic in encoder.plots]
    return _Form(encoder, Registered.of(schemas, channels), bulk)


@lru_cache(maxsize=8)  # the cells of a sweep look alike
def _description(urdf: str) -> Closed:
    text, records = urdf.encode() + b"\0", _description_records()
    head = bytes([0, 1, 0, 0]) + len(text).to_bytes(4, "little")  # CDR, little endian
    record = layout.record("/robot_description", Template().constant(head + text))
    payload = records.data + record.rows(1).tobytes()  # its slots stay 0: step 0, time 0
    entries = np.array([(0, len(records.data))], INDEX_ENTRY)
    return closed(payload, [Messages(1, entries)])


@lru_cache(maxsize=1)
def _description_records() -> Registered:
    schema = Schema(1, STRING_DEFINITION.encode(), "ros2msg", "std_msgs/msg/String")
    return Registered.of([schema], [_channel("/robot_description", 1, "cdr")])


def _end_of_group(encoded: Encoded, first: int, room: int) -> int:
    """Return the step that follows the one that fills the chunk; beyond the block if none does."""
    target = encoded.step_start[first] + room
    return int(np.searchsorted(encoded.step_start, target, "left"))


def _channel(
    topic: str, schema: int, encoding: str, meanings: Mapping[str, str] | None = None
) -> Channel:
    """Return a channel record; its metadata says what each column means."""
    return Channel(layout.CHANNELS[topic], topic, encoding, dict(meanings or {}), schema)


def _meanings(columns: Sequence[Column]) -> dict[str, str]:
    return {column.name: column.meaning for column in columns}
