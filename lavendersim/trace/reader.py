"""The reader of logs: columns, each loaded when it is first asked for.

Reading `step` or `residual` touches the light chunks only; `contact` and `pose` the bulk ones.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from mcap.records import Attachment, Schema
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.clock import Clock
from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import decode, layout
from lavendersim.trace.absent import absent_table
from lavendersim.trace.container import CRC_KEY, FileIndex
from lavendersim.trace.index import (
    ChunkContent,
    damage,
    parse,
    parse_metadata,
    read_at,
    read_chunk,
    read_summary,
)
from lavendersim.trace.scan import scan
from lavendersim.trace.schema import FORMAT, RESIDUAL_COLUMNS, STEP_COLUMNS, Column
from lavendersim.trace.writer import (
    ABSENT,
    AS_WRITTEN,
    DESCRIPTION,
    ENDING,
    RESOLVED,
    TIMESTEP_CHANGES,
)

COMPLETE = "complete"
INCOMPLETE = "incomplete"


class Trace:
    """One run's log. The columns and their units stand in `schema`."""

    def __init__(
        self, path: Path, index: FileIndex, finished: bool, config: CellConfig | None = None
    ) -> None:
        self.path = path
        if config is not None:
            self.config = config
        self._index = index
        with damage(path, "the metadata"):
            self.metadata = self._read_metadata()
            description = self.metadata[DESCRIPTION]
            if description["format"] != FORMAT:
                raise TraceError(
                    f"{path}: log format {description['format']}, this version reads {FORMAT}"
                )
            self.bodies: list[str] = json.loads(description["bodies"])
            self.clock = _clock(description)
            # topic -> why this log does without it; logs before there was a choice have them all
            self.absent: dict[str, str] = json.loads(description.get(ABSENT, "{}"))
            self.status = self.metadata[ENDING]["status"] if finished else INCOMPLETE
        self.complete = self.status == COMPLETE

    @property
    def timestep(self) -> Fraction:
        """Length of the first step [s]."""
        return self.clock.timestep

    @cached_property
    def timesteps(self) -> NDArray[np.float64]:
        """Length [s] of the step that ends in each row of `step`; of step 0, that of the first."""
        return self.clock.lengths(self.step["step"])

    @cached_property
    def step(self) -> NDArray[Any]:
        """One row per logged step: the file's columns, and `time` [s]."""
        with damage(self.path, "/step"):
            columns = self._columns("/step", "Step", STEP_COLUMNS)
            parts = [decode.decode_steps(c, columns) for c in self._chunks("/step")]
            return decode.join(parts, decode.step_columns(columns))

    @cached_property
    def residual(self) -> NDArray[Any]:
        """One row per sweep of the steps that were asked for: step, sweep, residual [m/s].

        Without /residuals an empty table, which gives the reason where a column is asked of it.
        """
        if "/residuals" in self.absent:
            return absent_table(self.why_not("/residuals"))
        with damage(self.path, "/residuals"):
            columns = self._columns("/residuals", "Sweep", RESIDUAL_COLUMNS)
            parts = [decode.decode_residuals(c, columns) for c in self._chunks("/residuals")]
            return decode.join(parts, decode.residual_columns(columns))

    @cached_property
    def pose(self) -> NDArray[np.float64]:
        """Poses (rows, bodies, 7): x y z [m], qw qx qy qz; the same rows as `step`.

        UsageError for a log without /tf.
        """
        if "/tf" in self.absent:
            raise UsageError(self.why_not("/tf"))
        with damage(self.path, "/tf"):
            form, count = layout.transforms_layout(self.bodies), len(self.bodies)
            parts = [decode.decode_poses(c, form, count) for c in self._chunks("/tf")]
            steps = np.concatenate([np.empty(0, np.int64), *(steps for steps, _ in parts)])
            if not np.array_equal(steps, self.step["step"]):
                raise ValueError("it has other steps than /step")
            empty = np.empty((0, len(self.bodies), layout.POSE))
            return np.concatenate([empty, *(poses for _, poses in parts)])

    @cached_property
    def contact(self) -> NDArray[Any]:
        """One row per contact and step: `step`, the file's columns, and `time` [s].

        Without /contacts an empty table, which gives the reason where a column is asked of it.
        """
        if "/contacts" in self.absent:
            return absent_table(self.why_not("/contacts"))
        parts = list(self.contacts_in_parts())
        return np.concatenate(parts) if parts else decode.join((), [("step", "i8"), ("time", "f8")])

    def contacts_in_parts(self) -> Iterator[NDArray[Any]]:
        """Yield the rows of `contact` in parts of whole steps, read as they are asked for.

        A long run of many bodies has more of them than memory holds. None without /contacts.
        """
        if "contact" in self.__dict__:  # read already
            yield self.contact
            return
        with damage(self.path, "/contacts"):
            frame = layout.root_frame(self.bodies)
            fields: tuple[layout.PackedField, ...] | None = None
            stride = 0
            for chunk in self._chunks("/contacts"):
                if fields is None:
                    fields, stride = decode.packed_fields(self._schema("/contacts"), chunk)
                yield decode.decode_contacts(chunk, fields, stride, frame)

    def why_not(self, topic: str) -> str:
        """Return the reason why this log has no such topic, as a sentence."""
        return f"{self.path}: this log has no {topic}: {self.absent[topic]}"

    @cached_property
    def as_written(self) -> str:
        """The config file as its author wrote it."""
        return self._attachment(AS_WRITTEN).decode()

    @cached_property
    def config(self) -> CellConfig:
        """The config of this cell with every default filled in.

        TraceError where another version wrote it so that this one cannot read it.
        """
        data = self.config_data()
        try:
            return CellConfig.from_dict(data)
        except ValueError as error:  # pydantic's: a count, then a key and what is wrong with it
            why = ": ".join(line.strip() for line in str(error).splitlines()[1:3])
            raise TraceError(
                f"{self.path}: its config was written by another version: {why}"
            ) from None

    def config_data(self) -> dict[str, Any]:
        """Return the config of this cell as the plain data that the log holds."""
        with damage(self.path, RESOLVED):
            loaded: dict[str, Any] = yaml.load(
                self._attachment(RESOLVED), getattr(yaml, "CSafeLoader", yaml.SafeLoader)
            )
            return loaded

    def _read_metadata(self) -> dict[str, dict[str, str]]:
        found = {}
        with self.path.open("rb") as stream:
            for entry in self._index.metadata:
                record = parse_metadata(read_at(stream, entry.offset, entry.length))
                found[record.name] = {k: v for k, v in record.metadata.items() if k != CRC_KEY}
        return found

    def _attachment(self, name: str) -> bytes:
        with damage(self.path, f"attachment {name}"), self.path.open("rb") as stream:
            (entry,) = (entry for entry in self._index.attachments if entry.name == name)
            record: Attachment = parse(read_at(stream, entry.offset, entry.length), Attachment)
            if record.name != name:
                raise ValueError("another one stands in its place")
            return record.data

    def _schema(self, topic: str) -> Schema:
        return self._index.schemas[self._index.channels[layout.CHANNELS[topic]].schema_id]

    def _columns(self, topic: str, message: str, default: tuple[Column, ...]) -> tuple[Column, ...]:
        """Return the columns of a topic; a run that ended before its first step has `default`."""
        if layout.CHANNELS[topic] not in self._index.channels:
            return default
        return decode.columns_in(self._schema(topic), message)

    def _chunks(self, topic: str) -> Iterator[ChunkContent]:
        """Yield the chunks that hold messages of a topic."""
        channel = layout.CHANNELS[topic]
        with self.path.open("rb") as stream:
            for entry in self._index.chunks:
                if channel in entry.message_index_offsets:
                    yield read_chunk(stream, entry)


def _clock(description: dict[str, str]) -> Clock:
    """Return the times of the steps of a log; logs before timesteps could change have none."""
    changes = json.loads(description.get(TIMESTEP_CHANGES, "[]"))
    first = Fraction(description["timestep"])
    return Clock.counted(first, [(done, Fraction(timestep)) for done, timestep in changes])


def open_trace(
    path: str | Path, allow_incomplete: bool = False, config: CellConfig | None = None
) -> Trace:
    """Return the log at `path`, its columns not yet read.

    config: that of its cell, where the caller has it already; it is not read from the log then.

    TraceError when the file is missing, damaged, or unfinished. With `allow_incomplete` a killed
    run is read up to its last whole group of steps; its status is `incomplete`.
    """
    path = Path(path)
    if not path.is_file():
        raise TraceError(f"{path}: no such log")
    try:
        return Trace(path, read_summary(path), finished=True, config=config)
    except TraceError:
        if not allow_incomplete:
            raise
    with damage(path, "the log"):
        return Trace(path, scan(path).entries, finished=False, config=config)
