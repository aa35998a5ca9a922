"""The writer of logs: blocks of steps into the chunks of an MCAP file.

Steps are cut into groups, and each group is two chunks, bulk then light; a log without poses and
contacts has light ones only. A group closes with the step that fills either stream, so where it
closes depends on the steps alone, never on how they came in or on a clock, and chunks stand in the
order in which they closed, whichever thread compressed them first: equal runs give equal bytes.
Bulk goes first: where a light chunk is whole, everything before it is, and a killed run is readable
up to its last light chunk.
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
from lavendersim.trace.container import (
    INDEX_ENTRY,
    Closed,
    Container,
    FileIndex,
    Messages,
    closed,
)
from lavendersim.trace.encode import Block, Encoded, Encoder
from lavendersim.trace.forms import description_chunk, description_records, form_of
from lavendersim.trace.schema import FORMAT
from lavendersim.trace.urdf import robot_description

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
        form = form_of(tuple(self._bodies), columns, frozenset(self._topics))
        self._encoder = form.encoder
        if "/robot_description" in self._topics:
            self._describe_geometry(block.pose[0].astype(np.float64))
        self._container.register(form.bulk)
        self._container.register(form.light)
        self._bulk, self._light = _Stream(form.bulk.data), _Stream(form.light.data)

    def _describe_geometry(self, poses: NDArray[np.float64]) -> None:
        """Write the chunk of /robot_description; poses: of the initial state (bodies, 7)."""
        self._container.register(description_records())
        self._write(description_chunk(robot_description(self._bodies, poses)))

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


def _end_of_group(encoded: Encoded, first: int, room: int) -> int:
    """Return the step that follows the one that fills the chunk; beyond the block if none does."""
    target = encoded.step_start[first] + room
    return int(np.searchsorted(encoded.step_start, target, "left"))
