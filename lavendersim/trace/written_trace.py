"""A log that this process has just written, read from the blocks that went into it.

The same columns as from the file, bit for bit: nothing is decoded that is still in memory.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lavendersim.record_tables import ROOM_FOR_TIME, widened
from lavendersim.trace import decode, layout
from lavendersim.trace.absent import table_without
from lavendersim.trace.blocks import Block
from lavendersim.trace.contact_columns import column_form
from lavendersim.trace.reader import RecordedPoses, Trace
from lavendersim.trace.recorded import is_recorded
from lavendersim.trace.schema import OF_THE_MESSAGE, RESIDUAL_COLUMNS, STEP_COLUMNS, columns_of
from lavendersim.trace.source import JustWritten
from lavendersim.trace.writer import Written


def trace_of(written: Written) -> Trace:
    """Return a log that this process has just written, its columns not yet read."""
    if not written.blocks:
        return Trace(written.path, JustWritten(written), config=written.config)
    return WrittenTrace(written, written.blocks)


class WrittenTrace(Trace):
    """A log whose blocks are at hand."""

    def __init__(self, written: Written, blocks: Sequence[Block]) -> None:
        super().__init__(written.path, JustWritten(written), config=written.config)
        self._blocks = blocks

    @cached_property
    def step(self) -> NDArray[Any]:
        """One row per logged step: the file's columns, and `time` [s]."""
        rows = [block.step for block in self._blocks]
        columns = decode.step_columns(columns_of(rows[0].dtype, STEP_COLUMNS))
        table = _table(rows, columns)
        table["time"] = decode.seconds(table["time_ns"])
        return table_without(table, self._not_reported("/step"))

    @cached_property
    def residual(self) -> NDArray[Any]:
        """One row per sweep of the steps that were asked for: step, sweep, residual [m/s]."""
        if "/residuals" in self.absent:
            return super().residual
        rows = [block.residual for block in self._blocks]
        names = [name for name in rows[0].dtype.names or () if name != OF_THE_MESSAGE]
        columns = columns_of(rows[0][names].dtype, RESIDUAL_COLUMNS)
        return _table(rows, decode.residual_columns(columns))

    @cached_property
    def recorded_pose(self) -> RecordedPoses:
        """The poses of the steps of which the log has them. UsageError for a log without /tf."""
        if not self.has("/tf"):
            return super().recorded_pose
        poses = np.concatenate([block.pose[:, :, : layout.POSE] for block in self._blocks])
        rows = self.recorded_rows("/tf")
        return RecordedPoses(rows, poses if len(rows) == len(poses) else poses[rows])

    @cached_property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities (rows, bodies, 6): vx vy vz [m/s], wx wy wz [rad/s]; the same rows as `step`.

        UsageError for a log without /velocities, or of some steps alone.
        """
        if {"/velocities", "/tf"} & self.absent.keys():
            return super().velocity
        velocities: NDArray[np.float64] = np.concatenate(
            [block.pose[:, :, layout.POSE :] for block in self._blocks]
        )
        return velocities

    def recorded_contacts_in_parts(self) -> Iterator[NDArray[Any]]:
        """Yield the rows of `recorded_contact` block by block, as they stand in memory.

        Blocks with room for it get the time behind each row; of others rows are copied.
        """
        if not self.has("/contacts"):
            yield from super().recorded_contacts_in_parts()
            return
        for contacts, times in self._recorded_rows():
            row = _with_time(contacts.dtype)
            has_room = row.itemsize == contacts.dtype.itemsize
            table = contacts.view(row) if has_room else widened(contacts, row)
            table["time"] = times
            yield table

    def _recorded_rows(self) -> Iterator[tuple[NDArray[Any], NDArray[np.float64]]]:
        """Yield contacts of each block, and the time of each [s]."""
        for block in self._blocks:
            contacts, steps = block.contact, block.step["step"]
            recorded = is_recorded(self.config.record.contacts, self.clock, steps)
            if not recorded.any():
                continue
            if not recorded.all():
                contacts = contacts[np.isin(contacts["step"], steps[recorded])]
            ends = contacts["step"].searchsorted(steps, "right")  # of each step, by rising step
            counts = ends.copy()
            counts[1:] -= ends[:-1]
            yield contacts, decode.seconds(block.step["time_ns"]).repeat(counts)


@lru_cache(maxsize=64)
def _with_time(row: np.dtype[Any]) -> np.dtype[Any]:
    """Return a row of contacts with its time behind it, its columns in the order of a reader.

    It is no longer where the row has room for that.
    """
    form = column_form(row)
    kinds = zip(form.names, form.kinds, strict=True)
    columns = [("step", "i8"), *kinds, *((name, "f8") for name in (*form.derived, "time"))]
    places = {name: place[1] for name, place in (row.fields or {}).items()}
    names = [name for name, _ in columns]
    used = max(place[0].itemsize + place[1] for place in (row.fields or {}).values())
    return np.dtype(
        {
            "names": names,
            "formats": ["=" + kind for _, kind in columns],
            "offsets": [places.get(name, used) for name in names],
            "itemsize": max(row.itemsize, used + ROOM_FOR_TIME),
        }
    )


def _table(parts: Sequence[NDArray[Any]], columns: Sequence[tuple[str, str]]) -> NDArray[Any]:
    """Return rows as a table of these columns; one that the rows lack is left to the caller."""
    table = np.empty(sum(map(len, parts)), [(name, "=" + kind) for name, kind in columns])
    begin = 0
    for part in parts:
        end = begin + len(part)
        for name, _ in columns:
            if name in (part.dtype.names or ()):
                table[name][begin:end] = part[name]
        begin = end
    return table
