"""The bytes of a block of steps: whole MCAP Message records, in a light and a bulk stream.

Per block, never per message: sizes from the counts, offsets by cumulative sum, then one scatter
for the fixed part of each kind of message and one for each kind of row that follows it.

    light   | /step /plot.. [/residuals: head, row, row, ..] | next step ..
    bulk    | /tf /contacts: head, point, point, ..          | next step ..

A topic that the log does without takes no byte; a stream without topics is empty.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.trace import layout
from lavendersim.trace.schema import (
    LOG10_RESIDUAL_FLOOR,
    PLOTS,
    RESIDUAL_COLUMNS,
    STEP_COLUMNS,
    columns_of,
)
from lavendersim.trace.wire import Bytes, Rows, Template, padded_varints, scatter, timestamps

# Okabe and Ito's colour-blind safe set
LOADED = (213, 94, 0, 255)  # vermilion: the contact carries an impulse
UNLOADED = (86, 180, 233, 255)  # sky blue: it does not


class Block(NamedTuple):
    """Many steps of a run, as numpy arrays; the columns are listed in `schema`.

    step: structured (n,). contact: structured, rows grouped by `step` ascending. pose: (n, bodies,
    7), x y z [m] and qw qx qy qz. residual: structured `step`, `sweep`, `residual`; may be empty.
    """

    step: NDArray[Any]
    contact: NDArray[Any]
    pose: NDArray[np.float64]
    residual: NDArray[Any]


class Encoded(NamedTuple):
    """One stream of a block: bytes, where each step starts, and where each message stands."""

    data: Bytes
    step_start: NDArray[np.int64]  # (n + 1,)
    messages: dict[int, tuple[Rows, Rows]]  # channel -> rows of the block, byte offsets


class Encoder:
    """The layouts of a run, fixed by its bodies, topics and columns; it holds nothing of a run."""

    def __init__(
        self, bodies: Sequence[str], columns: tuple[np.dtype[Any], ...], topics: Collection[str]
    ) -> None:
        """columns: of the tables step, contact and residual of every block."""
        step, contact, sweep = columns
        self._topics = topics
        self.step_columns = columns_of(step, STEP_COLUMNS)
        residual = [name for name in sweep.names or () if name != "step"]
        self.residual_columns = columns_of(sweep[residual], RESIDUAL_COLUMNS)
        names = step.names or ()
        self.plots = [t for t, name in PLOTS.items() if t in topics and name in names]
        self._dtypes = columns
        self._bodies = len(bodies)
        self._tf = layout.transforms_layout(bodies)
        if "/contacts" in topics:
            self.fields = layout.contact_fields(contact)
            self._point = contact.itemsize + layout.COLOUR_WORD  # [B]
            frame = layout.root_frame(bodies)
            self._cloud = layout.contact_layout(self.fields, self._point, frame)
        self._light = Template().embed(layout.step_layout(self.step_columns))
        self._starts = {layout.CHANNELS["/step"]: 0}
        for topic in self.plots:
            self._starts[layout.CHANNELS[topic]] = len(self._light)
            self._light.embed(layout.plot_layout(topic))
        self._sweeps = layout.residual_layout()
        self._sweep = layout.residual_row_layout(self.residual_columns)

    def encode(self, block: Block) -> tuple[Encoded, Encoded]:
        """Return the light and the bulk stream. ValueError when the block contradicts itself."""
        if (block.step.dtype, block.contact.dtype, block.residual.dtype) != self._dtypes:
            raise ValueError("a block has other columns than the first one")
        if block.pose.shape != (len(block.step), self._bodies, layout.POSE):
            raise ValueError(f"poses have shape {block.pose.shape}")
        for topic, rows in (("/contacts", block.contact), ("/residuals", block.residual)):
            if len(rows) and topic not in self._topics:
                raise ValueError(f"a block has rows for {topic}, which its log does without")
        return self._encode_light(block), self._encode_bulk(block)

    def _encode_light(self, block: Block) -> Encoded:
        step = block.step
        counts = _counts(step["step"], block.residual["step"], "residuals")
        asked = np.flatnonzero(counts)
        head, row = len(self._sweeps), len(self._sweep)
        sizes = np.full(len(step), len(self._light), np.int64)
        sizes[asked] += head + counts[asked] * row
        start = _cumulative(sizes)
        data = np.empty(start[-1], np.uint8)

        rows = self._clocked(self._light, step)
        words = [_words(step[column.name]) for column in self.step_columns]
        self._light.put(rows, "step", np.stack(words, axis=1))
        if self.plots:
            values = [_plotted(topic, step[PLOTS[topic]]) for topic in self.plots]
            self._light.put(rows, "plot", np.stack(values, axis=1))
        scatter(data, start[:-1], rows)

        every = np.arange(len(step))
        messages = {c: (every, start[:-1] + offset) for c, offset in self._starts.items()}
        if len(asked):
            heads = start[asked] + len(self._light)
            messages[layout.CHANNELS["/residuals"]] = (asked, heads)
            rows = self._clocked(self._sweeps, step[asked])
            self._sweeps.put(rows, "step", step["step"][asked])
            self._put_length(self._sweeps, rows, counts[asked] * row)
            scatter(data, heads, rows)
            tails = self._sweep.rows(len(block.residual))
            words = [_words(block.residual[column.name]) for column in self.residual_columns]
            self._sweep.put(tails, "sweep", np.stack(words, axis=1))
            scatter(data, _ranks(heads + head, counts[asked], row), tails)
        return Encoded(data, start, messages)

    def _encode_bulk(self, block: Block) -> Encoded:
        step = block.step
        posed, touching = "/tf" in self._topics, "/contacts" in self._topics
        sizes = np.full(len(step), len(self._tf) if posed else 0, np.int64)
        counts = _counts(step["step"], block.contact["step"], "contacts")
        if touching:
            sizes += len(self._cloud) + counts * self._point
        start = _cumulative(sizes)
        data = np.empty(start[-1], np.uint8)
        every = np.arange(len(step))
        messages: dict[int, tuple[Rows, Rows]] = {}
        heads = start[:-1]
        if posed:
            self._put_poses(data, heads, block)
            messages[layout.CHANNELS["/tf"]] = (every, heads)
            heads = heads + len(self._tf)
        if touching:
            self._put_contacts(data, heads, counts, block)
            messages[layout.CHANNELS["/contacts"]] = (every, heads)
        return Encoded(data, start, messages)

    def _put_poses(self, data: Bytes, heads: Rows, block: Block) -> None:
        step = block.step
        rows = self._clocked(self._tf, step)
        if self._bodies:
            poses = np.asarray(block.pose, "<f8")[:, :, [0, 1, 2, 4, 5, 6, 3]]
            self._tf.put(rows, "timestamp", _repeat(timestamps(step["time_ns"]), self._bodies))
            self._tf.put(rows, "pose", poses.reshape(len(step), -1))
        scatter(data, heads, rows)

    def _put_contacts(self, data: Bytes, heads: Rows, counts: Rows, block: Block) -> None:
        step, point = block.step, self._point
        rows = self._clocked(self._cloud, step)
        self._cloud.put(rows, "timestamp", timestamps(step["time_ns"]))
        self._cloud.put(rows, "data_length", padded_varints(counts * point))
        self._put_length(self._cloud, rows, counts * point)
        scatter(data, heads, rows)
        if len(block.contact):
            points = _ranks(heads + len(self._cloud), counts, point)
            rows = np.ascontiguousarray(block.contact).view(np.uint8)
            scatter(data, points, rows.reshape(len(block.contact), -1))
            scatter(data, points + block.contact.itemsize, _colours(block.contact))

    @staticmethod
    def _clocked(template: Template, step: NDArray[Any]) -> Bytes:
        """Return one row per step with sequence and clock filled."""
        rows = template.rows(len(step))
        template.put(rows, "sequence", step["step"].astype("<u4"))
        template.put(rows, "clock", step["time_ns"].astype("<u8"))
        return rows

    @staticmethod
    def _put_length(template: Template, rows: Bytes, tail: Rows) -> None:
        """Fill the record length: what follows the nine bytes of its header."""
        length = len(template) - layout.RECORD_HEADER + tail
        template.put(rows, "length", length.astype("<u8"))


def _colours(contact: NDArray[Any]) -> Bytes:
    """Return the colour words of contacts, (n, 8)."""
    words = np.zeros((2, layout.COLOUR_WORD), np.uint8)
    words[0, :4], words[1, :4] = UNLOADED, LOADED
    names = contact.dtype.names or ()
    loaded = contact["impulse_n"] > 0 if "impulse_n" in names else np.ones(len(contact), bool)
    return words[loaded.astype(np.intp)]


def _words(column: NDArray[Any]) -> Rows:
    """Return eight-byte numbers as little-endian void items, bit for bit."""
    return np.ascontiguousarray(column.astype(column.dtype.newbyteorder("<"))).view("V8")


def _plotted(topic: str, values: NDArray[Any]) -> NDArray[Any]:
    if not topic.endswith("log10_residual"):
        return values.astype("<f8")
    with np.errstate(divide="ignore", invalid="ignore"):
        drawn: NDArray[Any] = np.maximum(np.log10(values), LOG10_RESIDUAL_FLOOR).astype("<f8")
    return drawn


def _repeat(slots: Rows, count: int) -> Rows:
    return np.repeat(slots, count).reshape(len(slots), count)


def _cumulative(sizes: Rows) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)


def _counts(steps: NDArray[Any], owners: NDArray[Any], what: str) -> Rows:
    """Return how many rows each step owns. ValueError when they are out of order or strays."""
    ends = np.searchsorted(owners, steps, "right")
    counts = ends - np.searchsorted(owners, steps, "left")
    if counts.sum() != len(owners) or np.any(np.diff(owners) < 0):
        raise ValueError(f"{what} of a block are not grouped by its steps")
    return counts


def _ranks(starts: Rows, counts: Rows, size: int) -> Rows:
    """Return the byte offset of every row: rows of one owner stand one after the other."""
    before = _cumulative(counts)[:-1]
    row: Rows = np.repeat(starts - before * size, counts) + np.arange(counts.sum()) * size
    return row
