"""The bytes of a block of steps: whole MCAP Message records, in four streams.

Per block, never per message: sizes from the counts, offsets by cumulative sum, then one scatter
for the fixed part of each kind of message and one for each kind of row that follows it.

    columns  | rows of contacts, for `/contact_columns`; a chunk makes one message of them
    points   | /contacts: head, point, point, ..              | next step ..
    poses    | /tf                                            | next step ..
    light    | /step /plot.. [/residuals: head, row, row, ..] | next step ..

A topic that the log does without takes no byte; a stream without topics is empty.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from lavendersim.trace import layout
from lavendersim.trace.contact_columns import column_form
from lavendersim.trace.points import point_form, points_of
from lavendersim.trace.schema import (
    LOG10_RESIDUAL_FLOOR,
    PLOTS,
    RESIDUAL_COLUMNS,
    STEP_COLUMNS,
    columns_of,
)
from lavendersim.trace.wire import Bytes, Rows, Template, padded_varints, scatter, timestamps

Kind = TypeVar("Kind")
WORD = 8  # [B] of a number
STEP_OF_COLUMNS = 3 * WORD  # its number, its time, how many contacts it has


class Block(NamedTuple):
    """Many steps of a run, as numpy arrays; the columns are listed in `schema`.

    step: structured (n,). contact: structured, rows grouped by `step` ascending. pose: (n, bodies,
    7), x y z [m] and qw qx qy qz. residual: structured `step`, `sweep`, `residual`; may be empty.
    """

    step: NDArray[Any]
    contact: NDArray[Any]
    pose: NDArray[np.float64]
    residual: NDArray[Any]


class Columns(NamedTuple):
    """The contacts of a block that are recorded."""

    rows: NDArray[Any]
    steps: Rows  # number of each, (n,)
    row_start: NDArray[np.int64]  # (n + 1,)
    recorded: Rows  # whether those of a step are, (n,)
    counts: Rows


class Encoded(NamedTuple):
    """One stream of a block: bytes, where each step starts, and where each message stands."""

    data: Bytes
    step_start: NDArray[np.int64]  # (n + 1,)
    messages: dict[int, tuple[Rows, Rows]]  # channel -> rows of the block, byte offsets
    columns: Columns | None = None  # in place of bytes, of the stream of columns


class Streams(NamedTuple, Generic[Kind]):
    """One thing of each stream, in the order in which their chunks stand in the file."""

    columns: Kind
    points: Kind
    poses: Kind
    light: Kind


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
            self.point = point_form(contact)
            self.columns = column_form(contact)
            frame = layout.root_frame(bodies)
            self._cloud = layout.contact_layout(self.point.fields, self.point.size, frame)
        self._light = Template().embed(layout.step_layout(self.step_columns))
        self._starts = {layout.CHANNELS["/step"]: 0}
        for topic in self.plots:
            self._starts[layout.CHANNELS[topic]] = len(self._light)
            self._light.embed(layout.plot_layout(topic))
        self._sweeps = layout.residual_layout()
        self._sweep = layout.residual_row_layout(self.residual_columns)

    def encode(self, block: Block, posed: Rows, touched: Rows) -> Streams[Encoded]:
        """Return the streams of a block. ValueError when it contradicts itself.

        posed, touched: whether poses and contacts of each step are recorded, bool (n,).
        """
        if (block.step.dtype, block.contact.dtype, block.residual.dtype) != self._dtypes:
            raise ValueError("a block has other columns than the first one")
        if block.pose.shape != (len(block.step), self._bodies, layout.POSE):
            raise ValueError(f"poses have shape {block.pose.shape}")
        for topic, rows in (("/contacts", block.contact), ("/residuals", block.residual)):
            if len(rows) and topic not in self._topics:
                raise ValueError(f"a block has rows for {topic}, which its log does without")
        counts = _counts(block.step["step"], block.contact["step"], "contacts")
        contacts = block.contact
        if not touched.all():
            contacts = contacts[np.repeat(touched, counts)]
        return Streams(
            self._columns(block.step, contacts, counts, touched),
            self._encode_points(block.step, contacts, counts, touched),
            self._encode_poses(block, posed),
            self._encode_light(block),
        )

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

    def _encode_poses(self, block: Block, posed: Rows) -> Encoded:
        if "/tf" not in self._topics:
            return _nothing(len(block.step))
        start = _cumulative(posed * len(self._tf))
        data = np.empty(start[-1], np.uint8)
        kept = np.flatnonzero(posed)
        step, heads = block.step[kept], start[kept]
        rows = self._clocked(self._tf, step)
        if self._bodies:
            poses = np.asarray(block.pose[kept], "<f8")[:, :, [0, 1, 2, 4, 5, 6, 3]]
            self._tf.put(rows, "timestamp", _repeat(timestamps(step["time_ns"]), self._bodies))
            self._tf.put(rows, "pose", poses.reshape(len(step), self._bodies * layout.POSE))
        scatter(data, heads, rows)
        return Encoded(data, start, {layout.CHANNELS["/tf"]: (kept, heads)})

    def _columns(
        self, step: NDArray[Any], contacts: NDArray[Any], counts: Rows, touched: Rows
    ) -> Encoded:
        if "/contacts" not in self._topics:
            return _nothing(len(step))
        size = STEP_OF_COLUMNS + counts * WORD * len(self.columns.names)
        start = _cumulative(touched * size)
        rows = Columns(contacts, step["step"], _cumulative(touched * counts), touched, counts)
        return Encoded(np.empty(0, np.uint8), start, {}, rows)

    def _encode_points(
        self, step: NDArray[Any], contacts: NDArray[Any], counts: Rows, touched: Rows
    ) -> Encoded:
        if "/contacts" not in self._topics:
            return _nothing(len(step))
        point = self.point.size
        start = _cumulative(touched * (len(self._cloud) + counts * point))
        data = np.empty(start[-1], np.uint8)
        kept = np.flatnonzero(touched)
        step, heads, counts = step[kept], start[kept], counts[kept]
        rows = self._clocked(self._cloud, step)
        self._cloud.put(rows, "timestamp", timestamps(step["time_ns"]))
        self._cloud.put(rows, "data_length", padded_varints(counts * point))
        self._put_length(self._cloud, rows, counts * point)
        scatter(data, heads, rows)
        if len(contacts):
            offsets = _ranks(heads + len(self._cloud), counts, point)
            scatter(data, offsets, points_of(self.point, contacts))
        return Encoded(data, start, {layout.CHANNELS["/contacts"]: (kept, heads)})

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


def _nothing(steps: int) -> Encoded:
    """Return the stream of a topic that the log does without."""
    return Encoded(np.empty(0, np.uint8), np.zeros(steps + 1, np.int64), {})


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
