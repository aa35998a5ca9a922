"""The writer of logs: blocks of steps into the chunks of an MCAP file.

Steps are cut into groups, and each group is chunks of contacts, a chunk of poses, a light one; of
what a log does without there are none. A group closes with the step that fills its poses or its
light chunk. Contacts fill chunk after chunk of it: what poses of neighbouring steps have in common
is half of their bytes, and compression finds it where they stand together. Where chunks close
depends on the steps alone, never on how they came in or on a clock, and they stand in the order in
which they closed, whichever thread compressed them first: equal runs give equal bytes. The light
chunk is the last of its group: where it is whole, everything before it is, and a killed run is
readable up to its last light chunk.
"""

from __future__ import annotations

import json
import os
from collections import deque
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.trace import layout
from lavendersim.trace.contact_columns import ColumnForm, ContactGroup, message_of
from lavendersim.trace.container import (
    INDEX_ENTRY,
    Closed,
    Container,
    FileIndex,
    Messages,
    closed,
)
from lavendersim.trace.encode import Block, Encoded, Encoder, Streams
from lavendersim.trace.forms import description_chunk, description_records, form_of
from lavendersim.trace.recorded import RECORDED, described, is_recorded
from lavendersim.trace.schema import FORMAT
from lavendersim.trace.urdf import robot_description

# Small, so that a killed run loses little and a plot of the force reads little.
LIGHT_BYTES = 128 * 1024
# Large enough to compress well, small enough that a viewer can hold a few.
BULK_BYTES = 1024 * 1024
# Most of what a contact's numbers have in common they have with those of the step before.
COLUMNS: Final = "/contact_columns"
COLUMN_BYTES = 4 * 1024 * 1024
BEFORE: Final = ("columns", "points")  # may close before their group does
CHUNK_BYTES = Streams(COLUMN_BYTES, BULK_BYTES, BULK_BYTES, LIGHT_BYTES)

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

    def next(self) -> _Stream:
        """Return the stream that follows when this one is closed."""
        return _Stream(b"")


class _ColumnStream:
    """The open chunk of columns: contacts of whole steps, which become one message."""

    def __init__(self, prologue: bytes, form: ColumnForm | None = None) -> None:
        self.size = 0
        self._prologue, self._form = prologue, form
        self._parts: list[tuple[Any, ...]] = []  # rows, and number, time and count of each step

    def take(self, encoded: Encoded, times: Any, first: int, last: int) -> None:
        """Append the steps first..last of a block."""
        begin, end = int(encoded.step_start[first]), int(encoded.step_start[last])
        self.size += end - begin
        if encoded.columns is not None and end > begin:
            rows, steps, start, recorded, counts = encoded.columns
            kept = np.flatnonzero(recorded[first:last]) + first
            mine = rows[start[first] : start[last]]
            self._parts.append((mine, steps[kept], times[kept], counts[kept]))

    def close(self) -> Closed:
        """Return the chunk; may be called from any thread."""
        assert self._form is not None
        columns = zip(*self._parts, strict=True)
        rows, steps, times, counts = (np.concatenate(column) for column in columns)
        group = ContactGroup(steps, times.astype(np.int64), counts, rows)
        body = message_of(group, self._form)
        head = layout.message_head(COLUMNS, int(steps[0]), int(times[0]), sum(map(len, body)))
        payload = b"".join([self._prologue, head, *body])
        entries = np.array([(times[0], len(self._prologue))], INDEX_ENTRY)
        return closed(payload, [Messages(layout.CHANNELS[COLUMNS], entries)])

    def next(self) -> _ColumnStream:
        """Return the stream that follows when this one is closed."""
        return _ColumnStream(b"", self._form)


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
        self._clock = clock = config.clock
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
        if partly := described(config.record):
            self._describe(RECORDED, partly)
        for name, values in metadata.items():
            if name in (DESCRIPTION, ENDING, RECORDED):
                raise ValueError(f"metadata may not be called {name!r}")
            self._describe(name, values)
        self._open = _opened()
        self._closing: deque[Future[Closed]] = deque()  # in the order of the file
        self._kept: list[Closed] | None = []
        self._kept_bytes = 0

    def append(self, block: Block) -> None:
        """Write a block of steps; its arrays stay as they are until the log is closed.

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
        record = self._config.record
        posed, touched = (
            is_recorded(which, self._clock, step["step"])
            for which in (record.poses, record.contacts)
        )
        encoded = self._encoder.encode(block, posed, touched)
        times = step["time_ns"].astype(np.uint64)
        self._last_step = int(step["step"][-1])
        first = 0
        while first < len(step):
            ends = Streams(
                *map(_end_of_chunk, encoded, self._open, CHUNK_BYTES, [first] * len(encoded))
            )
            last = min(*ends, len(step))
            for stream, part in zip(self._open, encoded, strict=True):
                stream.take(part, times, first, last)
            if last == min(ends.poses, ends.light):
                self._close(*Streams._fields)
            else:
                self._close(*(name for name in BEFORE if last == getattr(ends, name)))
            first = last

    def close(self, status: str) -> Written:
        """End the log; status is `complete`, or why the run ended early."""
        for future in self._closing:
            self._write(future.result())
        self._closing.clear()
        for stream in self._open:
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
        form = form_of(tuple(self._bodies), columns, frozenset(self._topics))
        self._encoder = form.encoder
        if "/robot_description" in self._topics:
            self._describe_geometry(block.pose[0].astype(np.float64))
        for registered in form.streams:
            self._container.register(registered)
        first, *others = (registered.data for registered in form.streams)
        stored = form.encoder.columns if "/contacts" in self._topics else None
        self._open = Streams(_ColumnStream(first, stored), *map(_Stream, others))

    def _describe_geometry(self, poses: NDArray[np.float64]) -> None:
        """Write the chunk of /robot_description; poses: of the initial state (bodies, 7)."""
        self._container.register(description_records())
        self._write(description_chunk(robot_description(self._bodies, poses)))

    def _close(self, *names: str) -> None:
        """Hand open chunks to the compressing threads, and write those that are done.

        One without a message yet goes on, with the records that open its first chunk.
        """
        for name in names:
            stream = getattr(self._open, name)
            if stream.size:
                self._closing.append(_threads.submit(stream.close))
                self._open = self._open._replace(**{name: stream.next()})
        self._write_closed()

    def _write_closed(self) -> None:
        while self._closing and (self._closing[0].done() or len(self._closing) > MOST_WAITING):
            self._write(self._closing.popleft().result())

    def _write(self, one: Closed) -> None:
        self._container.write_chunk(one)
        self._kept_bytes += len(one.payload)
        if self._kept_bytes > KEPT_BYTES:
            self._kept = None
        if self._kept is not None:
            self._kept.append(one)


def _opened() -> Streams[Any]:
    return Streams(_ColumnStream(b""), _Stream(b""), _Stream(b""), _Stream(b""))


def _end_of_chunk(encoded: Encoded, stream: Any, most: int, first: int) -> int:
    """Return the step that follows the one that fills the chunk; beyond the block if none does."""
    target = encoded.step_start[first] + most - stream.size
    return int(np.searchsorted(encoded.step_start, target, "left"))
