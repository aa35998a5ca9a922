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
from numpy.typing import NDArray

from lavendersim.cell import CellConfig
from lavendersim.clock import Clock
from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import decode, layout
from lavendersim.trace.absent import absent_table
from lavendersim.trace.index import ChunkContent, damage, read_summary
from lavendersim.trace.scan import scan
from lavendersim.trace.schema import FORMAT, RESIDUAL_COLUMNS, STEP_COLUMNS, Column
from lavendersim.trace.source import JustWritten, LogFile, Source
from lavendersim.trace.writer import ABSENT, DESCRIPTION, ENDING, TIMESTEP_CHANGES, Written

COMPLETE = "complete"
INCOMPLETE = "incomplete"


class Trace:
    """One run's log. The columns and their units stand in `schema`."""

    def __init__(
        self, path: Path, source: Source, finished: bool, config: CellConfig | None = None
    ) -> None:
        self.path = path
        if config is not None:
            self.config = config
        self._source = source
        with damage(path, "the metadata"):
            self.metadata = source.metadata()
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
        if not parts:
            return decode.join((), [("step", "i8"), ("time", "f8")])
        # As bytes: of records numpy would join column by column.
        row = parts[0].dtype
        return np.concatenate([part.view(f"V{row.itemsize}") for part in parts]).view(row)

    def contacts_in_parts(self) -> Iterator[NDArray[Any]]:
        """Yield the rows of `contact` in parts of whole steps, read as they are asked for.

        A long run of many bodies has more of them than memory holds. None without /contacts.
        """
        if "contact" in self.__dict__:  # read already
            yield self.contact
            return
        with damage(self.path, "/contacts"):
            frame = layout.root_frame(self.bodies)
            fields: tuple[layout.PackedField, ...] = ()
            stride = 0
            for chunk in self._chunks("/contacts"):
                schema = self._source.schema(layout.CHANNELS["/contacts"])
                if not fields and schema is not None:
                    fields, stride = decode.packed_fields(schema, chunk)
                yield decode.decode_contacts(chunk, fields, stride, frame)

    def why_not(self, topic: str) -> str:
        """Return the reason why this log has no such topic, as a sentence."""
        return f"{self.path}: this log has no {topic}: {self.absent[topic]}"

    @cached_property
    def as_written(self) -> str:
        """The config file as its author wrote it."""
        return self._source.as_written()

    @cached_property
    def config(self) -> CellConfig:
        """The config of this cell with every default filled in.

        TraceError where another version wrote it so that this one cannot read it.
        """
        return self._source.config()

    def _columns(self, topic: str, message: str, default: tuple[Column, ...]) -> tuple[Column, ...]:
        """Return the columns of a topic; a run that ended before its first step has `default`."""
        schema = self._source.schema(layout.CHANNELS[topic])
        return default if schema is None else decode.columns_in(schema, message)

    def _chunks(self, topic: str) -> Iterator[ChunkContent]:
        return self._source.chunks(layout.CHANNELS[topic])


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
        return Trace(path, LogFile(path, read_summary(path)), finished=True, config=config)
    except TraceError:
        if not allow_incomplete:
            raise
    with damage(path, "the log"):
        return Trace(path, LogFile(path, scan(path).entries), finished=False, config=config)


def trace_of(written: Written) -> Trace:
    """Return a log that this process has just written, its columns not yet decoded."""
    return Trace(written.path, JustWritten(written), finished=True, config=written.config)
