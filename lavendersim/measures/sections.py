"""A log in sections of states, as much at a time as memory holds.

A section after the first begins with the last state of the one before, without its contacts: what
is taken over each step finds both its ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from lavendersim.cell import AnyEvent, CellConfig
from lavendersim.clock import Clock
from lavendersim.errors import TraceError
from lavendersim.measures.interfaces import Floats, Rows, Trace


class Section(NamedTuple):
    """Some states of a run as measures of single steps read them; see `interfaces.Trace`."""

    step: Rows
    contact: Rows
    pose: Floats
    bodies: Sequence[str]
    config: CellConfig
    clock: Clock
    absent: Mapping[str, str]
    before: int = 0  # states of the log before it; of its own the first is the last of these
    residual: Any = ()  # no measure of a single step needs sweeps, nor velocities
    velocity: Any = ()
    status: str = "complete"
    happened: Sequence[AnyEvent] | None = None  # None: the events of its config, at their times

    @property
    def events(self) -> Sequence[AnyEvent]:
        """What happened to it and when, up to its end."""
        return self.config.events if self.happened is None else self.happened

    def steps_in_parts(self) -> Iterator[Rows]:
        """Yield all states: a section fits into memory."""
        yield self.step

    def poses_in_parts(self) -> Iterator[tuple[Rows, Floats]]:
        """Yield all poses with the numbers of their steps."""
        yield self.step["step"], self.pose

    def contacts_in_parts(self) -> Iterator[Rows]:
        """Yield all contacts: a section fits into memory."""
        yield self.contact


class _Column:
    """One topic of a log, by rising step: parts that come in as they are asked for."""

    def __init__(self, parts: Iterator[tuple[Rows, Any]]) -> None:
        """parts: the numbers of their steps, and their rows."""
        self._parts = parts
        self._numbers: Any = np.empty(0, np.int64)
        self._rows: Any = None

    def fill(self) -> bool:
        """Have some rows at hand; false where there are no more."""
        while len(self._numbers) == 0:
            part = next(self._parts, None)
            if part is None:
                return False
            self._numbers, self._rows = part
        return True

    @property
    def last(self) -> int:
        """The step of the last row at hand."""
        return int(self._numbers[-1])

    def take(self, end: int) -> tuple[Rows, Any]:
        """Return what is at hand up to a step: the numbers of its steps, and its rows."""
        count = int(np.searchsorted(self._numbers, end, "right"))
        numbers, rows = self._numbers, self._rows
        self._numbers = numbers[count:]
        if rows is not None:
            self._rows, rows = rows[count:], rows[:count]
        return numbers[:count], rows


def sections_of(trace: Trace, whole: bool) -> Iterator[Section]:
    """Yield the states of a log in sections.

    whole: its last state counts; else it is left out. Parts are read as they are asked for and not
    kept: a log of any length takes as much memory as some of its chunks. Raises TraceError where
    poses are of other steps than states.
    """
    posed = "/tf" not in trace.absent
    step = _Column((part["step"], part) for part in _states(trace.steps_in_parts(), whole))
    pose = _Column(trace.poses_in_parts() if posed else iter(()))
    contact = _Column((part["step"], part) for part in trace.contacts_in_parts())
    begin, before = 0, None
    while step.fill():
        # A part of contacts has all those of its steps, and of steps before them that have none.
        end = min(column.last for column in (step, pose, contact) if column.fill())
        numbers, steps = step.take(end)
        posed_numbers, poses = pose.take(end)
        if not posed:
            poses = np.empty((len(steps), 0, 0))
        elif not np.array_equal(numbers, posed_numbers):
            raise TraceError("the poses of a log are of other steps than its states")
        _, contacts = contact.take(end)
        if contacts is None:
            contacts = trace.contact  # of a log that has none
        if before is not None:
            steps, poses = np.concatenate([before[0], steps]), np.concatenate([before[1], poses])
        same = trace.bodies, trace.config, trace.clock, trace.absent
        yield Section(steps, contacts, poses, *same, begin, happened=trace.events)
        begin += len(numbers)
        before = steps[-1:].copy(), poses[-1:].copy()


def _states(parts: Iterator[Rows], whole: bool) -> Iterator[Rows]:
    """Yield parts of states, the last state only where it counts."""
    if whole:
        yield from parts
        return
    last = None
    for part in parts:
        if len(part) == 0:
            continue
        if last is not None:
            yield last
        last = part
    if last is not None:
        yield last[:-1]
