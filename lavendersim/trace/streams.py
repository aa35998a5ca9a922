"""The four streams of a log: how rows of steps become the messages of a chunk."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from copy import copy
from fractions import Fraction
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.clock import Clock
from lavendersim.trace import layout
from lavendersim.trace.blocks import Counted, cumulative
from lavendersim.trace.contact_columns import ContactGroup, column_form, message_of
from lavendersim.trace.container import Messages
from lavendersim.trace.message_form import (
    MORE,
    STEP,
    TIME,
    WORD,
    MessageForm,
    columns_of_words,
    heads_of,
    message_form,
    words_of,
)
from lavendersim.trace.points import lay_points, point_form
from lavendersim.trace.predictors import Constants
from lavendersim.trace.schema import (
    LOG10_RESIDUAL_FLOOR,
    PLOTS,
    RESIDUAL_COLUMNS,
    STEP_COLUMNS,
    columns_of,
)
from lavendersim.trace.scratch import scratch
from lavendersim.trace.sphere_contacts import Starts
from lavendersim.trace.wire import INDEX_ENTRY, Rows, Template, rows_behind

STEP_OF_COLUMNS: Final = 3 * WORD  # its number, its time, how many contacts it has
TF_ORDER: Final = (0, 1, 2, 4, 5, 6, 3)  # x y z qx qy qz qw, of x y z qw qx qy qz
COLUMNS: Final = "/contact_columns"
# The bytes of a chunk, until its thread lays out the next, and where its messages stand.
Laid = tuple[bytes | memoryview, list[Messages]]


class Chunk:
    """The bytes of a chunk, filled part by part, and where its messages stand in it.

    They are the thread's own memory, which its next chunk fills anew.
    """

    def __init__(self, prologue: bytes, size: int) -> None:
        self.data = scratch("chunk", (len(prologue) + size,), np.uint8)
        self.data[: len(prologue)] = np.frombuffer(prologue, np.uint8)
        self.end = len(prologue)  # of what is filled
        self._entries: dict[int, list[NDArray[Any]]] = {}

    def note(self, topic: str, heads: Rows, starts: Rows) -> None:
        """Note where messages stand; heads: words of their steps."""
        entries = np.empty(len(starts), INDEX_ENTRY)
        entries["time"], entries["offset"] = heads[:, TIME], starts
        self._entries.setdefault(layout.CHANNELS[topic], []).append(entries)

    def filled(self) -> Laid:
        """Return bytes and index."""
        assert self.end == len(self.data), "a chunk has other bytes than were counted"
        messages = [
            Messages(channel, parts[0] if len(parts) == 1 else np.concatenate(parts))
            for channel, parts in sorted(self._entries.items())
        ]
        return self.data.data, messages


class Light:
    """`/step`, the plots, and the sweeps of steps that have them."""

    def __init__(
        self, step: np.dtype[Any], residual: np.dtype[Any], topics: Collection[str]
    ) -> None:
        self.step_columns = columns_of(step, STEP_COLUMNS)
        names = [name for name in residual.names or () if name != "step"]
        self.residual_columns = columns_of(residual[names], RESIDUAL_COLUMNS)
        self.plots = [t for t, name in PLOTS.items() if t in topics and name in (step.names or ())]
        light = Template().embed(layout.step_layout(self.step_columns))
        self._starts = {"/step": 0}
        for topic in self.plots:
            self._starts[topic] = len(light)
            light.embed(layout.plot_layout(topic))
        places = columns_of_words(step)
        columns = [places[column.name] for column in self.step_columns]
        heads = {"plot": [MORE + k for k in range(len(self.plots))]} if self.plots else {}
        self._light = message_form(light, {"step": columns}, heads)
        self._sweeps = message_form(
            layout.residual_layout(), {}, {"step": [STEP], "length": [MORE]}
        )
        places = columns_of_words(residual)
        columns = [places[column.name] for column in self.residual_columns]
        row = layout.residual_row_layout(self.residual_columns)
        self._sweep = message_form(row, {"sweep": columns}, {})

    def sizes(self, counted: Counted) -> Rows:
        """Return the bytes of each step [B] (n,)."""
        if not len(counted.block.residual):
            return np.full(len(counted.block.step), len(self._light), np.int64)
        swept = _counts(counted.residual_start)
        heads = (swept > 0) * len(self._sweeps)
        sizes: Rows = len(self._light) + heads + swept * len(self._sweep)
        return sizes

    def part(self, counted: Counted, first: int, last: int) -> Any:
        """Return the rows of steps and of their sweeps, and how many each has."""
        start = counted.residual_start[first : last + 1]
        sweeps = counted.block.residual[start[0] : start[-1]]
        return counted.block.step[first:last], sweeps, _counts(start)

    def encode(self, prologue: bytes, parts: Sequence[Any], size: int) -> Laid:
        """Return the bytes of a chunk and its index."""
        chunk = Chunk(prologue, size)
        for step, sweeps, swept in parts:
            sizes = len(self._light) + (swept > 0) * len(self._sweeps) + swept * len(self._sweep)
            starts = chunk.end + cumulative(sizes)
            plotted = [_plotted(topic, step[PLOTS[topic]]) for topic in self.plots]
            heads = heads_of(step, *plotted)
            self._light.fill(chunk.data, starts[:-1], words_of(step), heads)
            for topic, offset in self._starts.items():
                chunk.note(topic, heads, starts[:-1] + offset)
            if len(sweeps):
                self._fill_sweeps(chunk, starts[:-1] + len(self._light), step, sweeps, swept)
            chunk.end = int(starts[-1])
        return chunk.filled()

    def _fill_sweeps(
        self, chunk: Chunk, starts: Rows, step: Rows, sweeps: Rows, swept: Rows
    ) -> None:
        asked = np.flatnonzero(swept)
        starts, swept = starts[asked], swept[asked]
        heads = heads_of(step[asked], _record_length(self._sweeps, swept * len(self._sweep)))
        self._sweeps.fill(chunk.data, starts, heads, heads)
        chunk.note("/residuals", heads, starts)
        rows = rows_behind(starts + len(self._sweeps), swept, len(self._sweep))
        words = words_of(sweeps)
        self._sweep.fill(chunk.data, rows, words, words)


class Poses:
    """`/tf`: the poses of all bodies in a message; and their velocities in one behind it."""

    def __init__(self, bodies: Sequence[str], velocities: bool = False) -> None:
        width = layout.POSE + (layout.VELOCITY if velocities else 0)
        rows = [width * body for body in range(len(bodies))]
        columns = [row + k for row in rows for k in TF_ORDER]
        self._forms = {"/tf": _of_bodies(layout.transforms_layout(bodies), "pose", columns)}
        if velocities:
            columns = [row + layout.POSE + k for row in rows for k in range(layout.VELOCITY)]
            form = layout.velocities_layout(bodies)
            self._forms["/velocities"] = _of_bodies(form, "velocity", columns)
        self._size = sum(map(len, self._forms.values()))

    def sizes(self, counted: Counted) -> Rows:
        """Return the bytes of each step [B] (n,)."""
        sizes: Rows = counted.posed * self._size
        return sizes

    def part(self, counted: Counted, first: int, last: int) -> Any:
        """Return the rows and poses of the steps that have them recorded."""
        step, pose = counted.block.step[first:last], counted.block.pose[first:last]
        posed = counted.posed[first:last]
        return (step, pose) if posed.all() else (step[posed], pose[posed])

    def encode(self, prologue: bytes, parts: Sequence[Any], size: int) -> Laid:
        """Return the bytes of a chunk and its index."""
        chunk = Chunk(prologue, size)
        for step, pose in parts:
            words = np.ascontiguousarray(pose, np.float64).view(np.uint64).reshape(len(step), -1)
            heads, starts = heads_of(step), chunk.end + np.arange(len(step)) * self._size
            for topic, form in self._forms.items():
                form.fill(chunk.data, starts, words, heads)
                chunk.note(topic, heads, starts)
                starts = starts + len(form)
            chunk.end += len(step) * self._size
        return chunk.filled()


def _of_bodies(template: Template, slot: str, columns: Sequence[int]) -> MessageForm:
    """Return the form of a message of all bodies; a scene without any has no such slot."""
    return message_form(template, {slot: columns} if columns else {}, {})


class Before(NamedTuple):
    """The poses that the steps of a part begin with, from the state before the first."""

    before: NDArray[np.float64]  # (bodies, 7)
    following: NDArray[np.float64]  # (steps - 1, bodies, 7)


class Touched(NamedTuple):
    """The steps of a part that have contacts recorded."""

    step: Rows
    contacts: Rows  # of all of them, by step
    counts: Rows  # of contacts, by step
    poses: Before | None = None  # where contacts are expected by them


class Points:
    """`/contacts`: a cloud of points in a message."""

    def __init__(self, bodies: Sequence[str], contact: np.dtype[Any]) -> None:
        self._grid = 0.0
        self.form = point_form(contact)
        frame = layout.root_frame(bodies)
        cloud = layout.contact_layout(self.form.fields, self.form.size, frame)
        self._cloud = message_form(cloud, {}, {"length": [MORE], "data_length": [MORE + 1]})

    def on_grid(self, grid: float) -> Points:
        """Return the same for a scene whose positions are shown on a grid [m]."""
        points = copy(self)
        points._grid = grid
        return points

    def sizes(self, counted: Counted) -> Rows:
        """Return the bytes of each step [B] (n,)."""
        contacts = _counts(counted.contact_start)
        sizes: Rows = counted.touched * (len(self._cloud) + contacts * self.form.size)
        return sizes

    def part(self, counted: Counted, first: int, last: int) -> Touched:
        """Return the rows and contacts of the steps that have them recorded."""
        return _touched(counted, first, last)

    def encode(self, prologue: bytes, parts: Sequence[Touched], size: int) -> Laid:
        """Return the bytes of a chunk and its index."""
        chunk = Chunk(prologue, size)
        for step, contacts, counts, _ in parts:
            starts = chunk.end + cumulative(len(self._cloud) + counts * self.form.size)
            length = counts * self.form.size
            heads = heads_of(step, _record_length(self._cloud, length), length)
            self._cloud.fill(chunk.data, starts[:-1], heads, heads)
            chunk.note("/contacts", heads, starts[:-1])
            first = starts[:-1] + len(self._cloud)
            lay_points(self.form, chunk.data, first, counts, contacts, self._grid)
            chunk.end = int(starts[-1])
        return chunk.filled()


class ContactColumns:
    """`/contact_columns`: one message of all contacts of a chunk."""

    def __init__(self, contact: np.dtype[Any]) -> None:
        self.form = column_form(contact)
        self._clock, self._slop = Clock(Fraction(1)), 0.0
        self._bodies: NDArray[np.float64] | None = None

    def expecting(
        self, clock: Clock, slop: float, bodies: NDArray[np.float64] | None
    ) -> ContactColumns:
        """Return the same for a run with these timesteps, and this gap that counts as none [m].

        bodies: see `sphere_contacts`; None where nothing is expected by them.
        """
        columns = copy(self)
        columns._clock, columns._slop, columns._bodies = clock, slop, bodies
        return columns

    def sizes(self, counted: Counted) -> Rows:
        """Return the bytes of each step before they are packed [B] (n,)."""
        contacts = _counts(counted.contact_start)
        sizes: Rows = counted.touched * (STEP_OF_COLUMNS + contacts * WORD * len(self.form.names))
        return sizes

    def part(self, counted: Counted, first: int, last: int) -> Touched:
        """Return the rows and contacts of the steps that have them recorded.

        And the poses of the state before, and those of the steps, where contacts are expected by
        them.
        """
        if self._bodies is None:
            return _touched(counted, first, last)
        pose = counted.block.pose
        before = pose[first - 1] if first else counted.before
        poses = Before(pose[0] if before is None else before, pose[first : last - 1])
        return _touched(counted, first, last)._replace(poses=poses)

    def encode(self, prologue: bytes, parts: Sequence[Touched], size: int) -> Laid:
        """Return the bytes of a chunk and its index."""
        steps = [part.step for part in parts if len(part.step)]
        numbers = np.concatenate([step["step"] for step in steps])
        times = np.concatenate([step["time_ns"] for step in steps])
        counts = np.concatenate([part.counts for part in parts])
        rows = [part.contacts for part in parts]
        constants = Constants(float(self._clock.lengths(numbers[:1])[0]), self._slop)
        group = ContactGroup(numbers, times, counts, rows, self._starts(parts, counts))
        body = message_of(group, self.form, constants)
        head = layout.message_head(COLUMNS, int(numbers[0]), int(times[0]), sum(map(len, body)))
        entries = np.array([(times[0], len(prologue))], INDEX_ENTRY)
        pieces = [np.frombuffer(one, np.uint8) for one in (prologue, head, *body)]
        data = scratch("chunk", (sum(map(len, pieces)),), np.uint8)
        np.concatenate(pieces, out=data)
        return data.data, [Messages(layout.CHANNELS[COLUMNS], entries)]

    def _starts(self, parts: Sequence[Touched], counts: Rows) -> Starts | None:
        """Return where bodies are at the start of each step of some parts."""
        if self._bodies is None:
            return None
        known = [part.poses for part in parts if part.poses is not None]
        poses = [pose for one in known for pose in (one.before[None], one.following)]
        positions = [pose[:, :, :3] for pose in poses]
        rows = np.arange(len(counts)).repeat(counts)
        known_at = np.concatenate(positions).astype(np.float64, copy=False)
        return Starts(self._bodies, known_at, rows)


def _touched(counted: Counted, first: int, last: int) -> Touched:
    """Return the steps that have contacts recorded, with these."""
    step, start = counted.block.step[first:last], counted.contact_start[first : last + 1]
    contacts, counts = counted.block.contact[start[0] : start[-1]], _counts(start)
    touched = counted.touched[first:last]
    if touched.all():
        return Touched(step, contacts, counts)
    return Touched(step[touched], contacts[np.repeat(touched, counts)], counts[touched])


def _counts(starts: Rows) -> Rows:
    """Return how many rows begin at each of these; numpy's own `diff` is written for any array."""
    counts: Rows = starts[1:] - starts[:-1]
    return counts


def _plotted(topic: str, values: NDArray[Any]) -> NDArray[np.float64]:
    if not topic.endswith("log10_residual"):
        return np.ascontiguousarray(values, np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        drawn: NDArray[np.float64] = np.maximum(np.log10(values), LOG10_RESIDUAL_FLOOR)
    return drawn


def _record_length(head: Any, tail: Rows) -> Rows:
    """Return the length in a record's header, which does not count: of a head and its tail."""
    length: Rows = len(head) - layout.RECORD_HEADER + tail
    return length
