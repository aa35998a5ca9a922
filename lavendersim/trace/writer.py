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
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.trace import layout
from lavendersim.trace.blocks import Block, Counted, cumulative
from lavendersim.trace.chunk_queue import ChunkQueue
from lavendersim.trace.container import Closed, Container, FileIndex, closed
from lavendersim.trace.encode import Encoder, Streams, checked, encoders_of_cell
from lavendersim.trace.forms import Form, description_chunk, description_records, form_of
from lavendersim.trace.recorded import RECORDED, described, is_recorded
from lavendersim.trace.schema import FORMAT
from lavendersim.trace.urdf import robot_description
from lavendersim.trace.whole import LogDigest

# Small, so that a killed run loses little: some 5,000 steps. Closing a group costs as much as
# laying out a thousand steps of one ball.
LIGHT_BYTES = 2 * 1024 * 1024
# Large enough to compress well, small enough that a viewer can hold a few.
BULK_BYTES = 4 * 1024 * 1024
# Most of what a contact's numbers have in common they have with those of the step before.
COLUMN_BYTES = 16 * 1024 * 1024
BEFORE: Final = ("columns", "points")  # may close before their group does
CHUNK_BYTES = Streams(COLUMN_BYTES, BULK_BYTES, BULK_BYTES, LIGHT_BYTES)

# Of a log with rows up to this size [byte] they are kept: who wrote it reads them from memory.
KEPT_BYTES: Final = 256 * 1024 * 1024

AS_WRITTEN, RESOLVED = "config.yaml", "resolved.json"  # attachments
DESCRIPTION, ENDING = "trace", "lavender"  # metadata written first and last
# Metadata of columns that another engine does not report: /topic.column -> why.
NOT_REPORTED_COLUMNS: Final = "not_reported"
ABSENT = "absent"  # of the description: topic -> why the log does without it
TIMESTEP_CHANGES = "timestep_changes"  # and [steps done, timestep] of each; where there are any


class _Stream:
    """The open chunk of one stream: parts of blocks, laid out when it closes."""

    def __init__(self, encoder: Encoder, prologue: bytes) -> None:
        self.size = 0  # message bytes; the prologue does not count
        self._encoder, self._prologue = encoder, prologue
        self._parts: list[Any] = []

    def take(self, counted: Counted, start: Any, first: int, last: int) -> None:
        """Append the steps first..last of a block; start: where each begins in the stream."""
        size = int(start[last] - start[first])
        if size:
            self._parts.append(self._encoder.part(counted, first, last))
            self.size += size

    def close(self) -> Closed:
        """Return the chunk; may be called from any thread."""
        return closed(*self._encoder.encode(self._prologue, self._parts, self.size))

    def next(self) -> _Stream:
        """Return the stream that follows when this one is closed."""
        return _Stream(self._encoder, b"")


def description_of(config: CellConfig, absent: Mapping[str, str]) -> dict[str, str]:
    """Return the metadata that a log of this config begins with; absent: topics it does without."""
    clock = config.clock
    found = {
        "format": FORMAT,
        "bodies": _names(tuple(config.scene.bodies)),
        "timestep": str(clock.timestep),
        ABSENT: _reasons(tuple(sorted(absent.items()))),
    }
    if clock.changes:
        changes = [[done, str(timestep)] for done, timestep in clock.changes]
        found[TIMESTEP_CHANGES] = json.dumps(changes)
    return found


@lru_cache(maxsize=64)  # the cells of a sweep have the same bodies, and do without the same topics
def _names(bodies: tuple[str, ...]) -> str:
    return json.dumps(bodies)


@lru_cache(maxsize=64)
def _reasons(absent: tuple[tuple[str, str], ...]) -> str:
    return json.dumps(dict(absent))


class Written(NamedTuple):
    """A log that was just written, for who reads it in the same process."""

    path: Path
    entries: FileIndex
    metadata: dict[str, dict[str, str]]
    as_written: str
    config: CellConfig
    blocks: list[Block] | None  # None: too much to keep, they are read from the file
    digest: LogDigest


class TraceWriter:
    """Writes the log of one run; without `close` the file is a killed run, recoverable."""

    def __init__(
        self,
        path: str | Path,
        config: CellConfig,
        as_written: str,
        metadata: Mapping[str, Mapping[str, str]],
        absent: Mapping[str, str] | None = None,
        copy: Path | None = None,
    ) -> None:
        """Open the file. absent: the topics that this log does without, each with the reason.

        copy: another file, for who reads along: chunks close with their bytes, the first of a slow
        scene after minutes. Those of the copy close with every block; it is left without an end.
        """
        absent = dict(absent or {})
        self._copy: TraceWriter | None = None
        if copy is not None:
            self._copy = TraceWriter(copy, config, as_written, metadata, absent)
        if unknown := absent.keys() - layout.CHANNELS.keys():
            raise ValueError(f"no topics of a log: {sorted(unknown)}")
        self._topics = layout.CHANNELS.keys() - absent.keys()
        self._path = path if isinstance(path, Path) else Path(path)
        self._config, self._as_written = config, as_written
        self._bodies = config.scene.bodies
        self._clock = config.clock
        self._form: Form | None = None
        self._last_step = -1
        self._last_pose: NDArray[np.float64] | None = None
        self._container = Container(self._path)
        self._container.attach(AS_WRITTEN, "application/yaml", as_written.encode())
        self._container.attach(RESOLVED, "application/json", config.as_json().encode())
        self._metadata: dict[str, dict[str, str]] = {}
        self._describe(DESCRIPTION, description_of(config, absent))
        if partly := described(config.record):
            self._describe(RECORDED, partly)
        for name, values in metadata.items():
            if name in (DESCRIPTION, ENDING, RECORDED):
                raise ValueError(f"metadata may not be called {name!r}")
            self._describe(name, values)
        self._open: dict[str, _Stream] = {}  # by the names of Streams; none before the first step
        self._queue = ChunkQueue(self._container)
        self._kept: list[Block] | None = []
        self._kept_bytes = 0

    def append(self, block: Block) -> None:
        """Write a block of steps; its arrays stay as they are until the log is closed.

        ValueError when it contradicts itself or the blocks before.
        """
        step = block.step
        if not len(step):
            return
        steps = np.ascontiguousarray(step["step"])
        ascends = steps[0] > self._last_step and (steps[1:] > steps[:-1]).all()
        if not ascends or steps[-1] >= 2**32:
            raise ValueError("steps do not ascend, or exceed 32 bits")
        if "/step" not in self._topics:
            raise ValueError("a log without /step takes no steps")
        if self._form is None:
            self._begin(block)
        assert self._form is not None
        record = self._config.record
        posed, touched = (
            is_recorded(which, self._clock, steps) for which in (record.poses, record.contacts)
        )
        columns, topics, bodies = self._form.columns, self._topics, len(self._bodies)
        counted = checked(block, posed, touched, columns, topics, bodies)
        counted = counted._replace(before=self._last_pose)
        self._last_pose = block.pose[-1]
        starts = Streams(*(cumulative(encoder.sizes(counted)) for encoder in self._encoders))
        self._last_step = int(steps[-1])
        self._keep(block)
        first = 0
        while first < len(step):
            streams = self._open.values()
            ends = Streams(*map(_end_of_chunk, starts, streams, CHUNK_BYTES, [first] * 4))
            last = min(*ends, len(step))
            for stream, start in zip(streams, starts, strict=True):
                stream.take(counted, start, first, last)
            if last == min(ends.poses, ends.light):
                self._close(*Streams._fields)
            else:
                self._close(*(name for name in BEFORE if last == getattr(ends, name)))
            first = last
        if self._copy is not None:
            self._copy.append(block)
            self._copy.write_out()

    def write_out(self) -> None:
        """Close the open chunks, whatever they hold: all that came can be read from the file."""
        self._close(*self._open)
        self._queue.drain()

    def close(self, status: str) -> Written:
        """End the log; status is `complete`, or why the run ended early."""
        if self._copy is not None:
            self._copy.abandon()
        if sum(stream.size for stream in self._open.values()) > BULK_BYTES:
            self._close(*self._open)
        self._queue.drain()
        for stream in self._open.values():
            if stream.size:
                self._container.write_chunk(stream.close(), flush=False)  # the log ends with them
        self._describe(ENDING, {"status": status})
        digest = self._container.finish()
        index, described, written = self._container.index, self._metadata, self._as_written
        return Written(self._path, index, described, written, self._config, self._kept, digest)

    def abandon(self) -> None:
        """Let the file go as a killed run would leave it."""
        self._queue.drain()
        self._container.abandon()

    def _describe(self, name: str, values: Mapping[str, str]) -> None:
        self._container.describe(name, values)
        self._metadata[name] = dict(values)

    def _begin(self, block: Block) -> None:
        """Write the scene's geometry and open the streams: the columns are known now."""
        columns = block.step.dtype, block.contact.dtype, block.residual.dtype
        # Rows have them unasked where the config's `effects` switch their log on by hand.
        if not self._config.record.velocities and block.pose.shape[2:] == (layout.POSE,):
            self._topics -= {"/velocities"}
        self._form = form = form_of(tuple(self._bodies), columns, frozenset(self._topics))
        if "/robot_description" in self._topics:
            poses = block.pose[0, :, : layout.POSE].astype(np.float64)
            # Of a run in one block more follows at once.
            self._describe_geometry(poses, flush=block.step["step"][-1] < self._config.steps)
        for registered in form.streams:
            self._container.register(registered)
        self._encoders = encoders_of_cell(form.encoders, self._config)
        for name, encoder, registered in zip(
            Streams._fields, self._encoders, form.streams, strict=True
        ):
            self._open[name] = _Stream(encoder, registered.data)

    def _describe_geometry(self, poses: NDArray[np.float64], flush: bool) -> None:
        """Write the chunk of /robot_description; poses: of the initial state (bodies, 7)."""
        chunk = description_chunk(robot_description(self._bodies, poses))
        self._container.register(description_records())
        self._container.write_chunk(chunk, flush)

    def _close(self, *names: str) -> None:
        """Hand open chunks over, to be compressed and written beside.

        One without a message yet goes on, with the records that open its first chunk.
        """
        for name in names:
            stream = self._open[name]
            if stream.size:
                self._queue.put(stream.close, stream.size)
                self._open[name] = stream.next()

    def _keep(self, block: Block) -> None:
        self._kept_bytes += sum(rows.nbytes for rows in block)
        if self._kept_bytes > KEPT_BYTES:
            self._kept = None
        if self._kept is not None:
            self._kept.append(block)


def _end_of_chunk(start: Any, stream: _Stream, most: int, first: int) -> int:
    """Return the step that follows the one that fills the chunk; beyond the block if none does."""
    target = start[first] + most - stream.size
    return len(start) if start[-1] < target else int(start.searchsorted(target, "left"))
