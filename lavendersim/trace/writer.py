"""The writer of logs: blocks of steps into the chunks of an MCAP file.

Steps are cut into groups, and each group is two chunks, bulk then light; a log without poses and
contacts has light ones only. A group closes with the
step that fills either stream, so where it closes depends on the steps alone, never on how they
came in or on a clock: equal runs give equal bytes. Bulk goes first: where a light chunk is whole,
everything before it is, and a killed run is readable up to its last light chunk.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from mcap.records import Channel, Schema
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.trace import descriptors, layout
from lavendersim.trace.container import INDEX_ENTRY, Container, Messages
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

AS_WRITTEN, RESOLVED = "config.yaml", "resolved.yaml"  # attachments
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

    def finish(self) -> tuple[bytes, list[Messages]]:
        """Return payload and messages."""
        entries = sorted(self._entries.items())
        messages = [Messages(channel, np.concatenate(parts)) for channel, parts in entries]
        return b"".join(self._pieces), messages


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
        self._bodies = config.scene.bodies
        clock = config.clock
        self._encoder: Encoder | None = None
        self._last_step = -1
        self._container = Container(Path(path))
        text = yaml.safe_dump(config.as_dict(), sort_keys=False, allow_unicode=True)
        self._container.attach(AS_WRITTEN, "application/yaml", as_written.encode())
        self._container.attach(RESOLVED, "application/yaml", text.encode())
        description = {
            "format": FORMAT,
            "bodies": json.dumps(list(self._bodies)),
            "timestep": str(clock.timestep),
            ABSENT: json.dumps(absent, sort_keys=True),
        }
        if clock.changes:
            changes = [[done, str(timestep)] for done, timestep in clock.changes]
            description[TIMESTEP_CHANGES] = json.dumps(changes)
        self._container.describe(DESCRIPTION, description)
        for name, values in metadata.items():
            if name in (DESCRIPTION, ENDING):
                raise ValueError(f"metadata may not be called {name!r}")
            self._container.describe(name, values)
        self._light, self._bulk = _Stream(b""), _Stream(b"")
        # zstd runs beside the simulation; one chunk pair at a time keeps order and memory
        self._pool = ThreadPoolExecutor(1, "trace")
        self._writing: Future[None] | None = None

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

    def close(self, status: str) -> None:
        """End the log; status is `complete`, or why the run ended early."""
        if self._light.size:
            self._close_group()
        self._wait()
        self._pool.shutdown()
        self._container.describe(ENDING, {"status": status})
        self._container.finish()

    def abandon(self) -> None:
        """Let the file go as a killed run would leave it."""
        self._pool.shutdown()
        self._container.abandon()

    def _begin(self, block: Block) -> None:
        """Write the scene's geometry and open the streams: the columns are known now."""
        self._encoder = encoder = Encoder(list(self._bodies), block, self._topics)
        if "/robot_description" in self._topics:
            self._describe_geometry(block.pose[0].astype(np.float64))
        schemas, channels = [], []
        if "/tf" in self._topics:
            form = descriptors.transforms_schema()
            schemas.append(Schema(2, form, "protobuf", "foxglove.FrameTransforms"))
            channels.append(_channel("/tf", 2, "protobuf"))
        if "/contacts" in self._topics:
            form = descriptors.point_cloud_schema()
            schemas.append(Schema(3, form, "protobuf", "foxglove.PointCloud"))
            names = [field.name for field in encoder.fields]
            meanings = {name: CONTACT_COLUMNS[name] for name in names if name in CONTACT_COLUMNS}
            channels.append(_channel("/contacts", 3, "protobuf", meanings))
        self._bulk = _Stream(self._container.register(schemas, channels))

        step, sweep = encoder.step_columns, encoder.residual_columns
        schemas = [Schema(4, descriptors.step_schema(step), "protobuf", "lavender.Step")]
        channels = [_channel("/step", 4, "protobuf", _meanings(step))]
        if "/residuals" in self._topics:
            form = descriptors.residuals_schema(sweep)
            schemas.append(Schema(5, form, "protobuf", "lavender.Residuals"))
            channels.append(_channel("/residuals", 5, "protobuf", _meanings(sweep)))
        if encoder.plots:
            form = MULTI_ARRAY_DEFINITION.encode()
            schemas.append(Schema(6, form, "ros2msg", "std_msgs/msg/Float64MultiArray"))
            channels += [_channel(topic, 6, "cdr") for topic in encoder.plots]
        self._light = _Stream(self._container.register(schemas, channels))

    def _describe_geometry(self, poses: NDArray[np.float64]) -> None:
        """Write the chunk of /robot_description; poses: of the initial state (bodies, 7)."""
        text = robot_description(self._bodies, poses).encode() + b"\0"
        schema = Schema(1, STRING_DEFINITION.encode(), "ros2msg", "std_msgs/msg/String")
        prologue = self._container.register([schema], [_channel("/robot_description", 1, "cdr")])
        head = bytes([0, 1, 0, 0]) + len(text).to_bytes(4, "little")  # CDR, little endian
        record = layout.record("/robot_description", Template().constant(head + text))
        payload = prologue + record.rows(1).tobytes()  # its slots stay 0: step 0, time 0
        entries = np.array([(0, len(prologue))], INDEX_ENTRY)
        self._container.write_chunk(payload, [Messages(1, entries)])

    def _close_group(self) -> None:
        """Hand the open chunks to the writing thread."""
        self._wait()
        self._writing = self._pool.submit(self._write_group, self._bulk, self._light)
        self._bulk, self._light = _Stream(b""), _Stream(b"")

    def _write_group(self, *streams: _Stream) -> None:
        for stream in streams:
            if stream.size:
                self._container.write_chunk(*stream.finish())

    def _wait(self) -> None:
        """Wait for the writing thread; what went wrong there is raised here."""
        if self._writing is not None:
            self._writing.result()
            self._writing = None


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
