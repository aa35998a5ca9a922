"""What may be shown of a run while it goes on: what it compiles, and how far its cells are.

Whoever shows it asks, as often as it likes: `Tally.read` may be called by another thread at any
time. A cell hands out the engine's own count of steps, which grows within a call of the kernel too,
so that its loop has nothing to do for a display, and nothing where there is none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from threading import Lock
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from lavendersim.scene.plan import Plan

    from .cell import CellJob

SHORTEST = 0.5  # [s] of work before its speed means anything


class Compilation(NamedTuple):
    """A kernel that is about to be compiled."""

    plan: Plan
    title: str  # how the plan differs from the others of the sweep
    number: int  # from 1
    total: int


class Moment(NamedTuple):
    """How far the cells of a run are."""

    cells_done: int
    cells: int
    seconds_done: float  # [s] simulated, in all cells
    seconds: float  # [s] to be simulated, in all cells
    label: str | None  # of the cell that runs in this process; None: none does
    cell_seconds_done: float  # [s] simulated in it
    cell_seconds: float  # [s] to be simulated in it
    share: float  # of all steps, those that are done
    worked: float  # [s] by the clock on the wall, in which cells ran; without compilation
    remaining: float | None  # [s] by the same clock; None: not known yet
    written: int  # [B] of the logs of ended cells and of the one that runs in this process


class Tally:
    """The cells of a run, those that ended and the one that this process runs."""

    def __init__(self, jobs: Sequence[CellJob], now: Callable[[], float] = perf_counter) -> None:
        self._jobs, self._now = jobs, now
        self._ended: list[CellJob] = []
        self._current: tuple[CellJob, Callable[[], int]] | None = None
        self._worked = 0.0  # [s] in which cells ran, before `_since`
        self._since: float | None = None  # cells run since then
        self._in_others = False
        self._steps_before, self._worked_before = 0, 0.0  # at another speed: by this process alone
        self._lock = Lock()
        self._summed = 0  # ended cells that are in the sums
        self._steps, self._seconds, self._bytes = 0, 0.0, 0

    def begin(self, job: CellJob, steps_done: Callable[[], int]) -> None:
        """Note that a cell begins here; steps_done: reads how many steps it has done."""
        with self._lock:
            self._current = job, steps_done
            self._since = self._now()

    def begin_in_others(self) -> None:
        """Note that from now on other processes run cells."""
        steps = sum(job.config.steps for job in self._ended)
        with self._lock:
            self._in_others, self._steps_before = True, steps
            self._worked_before, self._since = self._worked, self._now()

    def end(self, job: CellJob) -> None:
        """Note that a cell has ended, wherever it ran."""
        with self._lock:  # who reads in between would find it neither running nor ended
            if not self._in_others and self._since is not None:
                self._worked += self._now() - self._since
                self._since = None
            self._current = None
            self._ended.append(job)

    @cached_property
    def _whole(self) -> tuple[int, float]:
        """The steps and the seconds of all cells."""
        return sum(job.config.steps for job in self._jobs), sum(map(_duration, self._jobs))

    def read(self) -> Moment:
        """Return how far the cells are now."""
        with self._lock:
            current = self._current
            ended = len(self._ended)
            for job in self._ended[self._summed : ended]:
                self._steps += job.config.steps
                self._seconds += _duration(job)
                self._bytes += _size(job)
            self._summed = ended
            done = current[1]() if current is not None else 0
            in_cell = float(current[0].config.clock.time(done)) if current is not None else 0.0
            steps, seconds = self._whole
            since = self._since
            worked = self._worked + (self._now() - since if since is not None else 0.0)
            return Moment(
                cells_done=ended,
                cells=len(self._jobs),
                seconds_done=self._seconds + in_cell,
                seconds=seconds,
                label=_label(current[0]) if current is not None else None,
                cell_seconds_done=in_cell,
                cell_seconds=_duration(current[0]) if current is not None else 0.0,
                share=(self._steps + done) / steps,
                worked=worked,
                remaining=self._remaining(self._steps + done, steps, worked),
                written=self._bytes + (_size(current[0]) if current is not None else 0),
            )

    def _remaining(self, done: int, steps: int, worked: float) -> float | None:
        """Return the time [s] that the rest takes at the speed of the steps so far."""
        done_since, lately = done - self._steps_before, worked - self._worked_before
        if lately < SHORTEST or done_since <= 0:
            return None
        return lately * (steps - done) / done_since


class Progress(NamedTuple):
    """What a caller may want to show while a sweep runs; every hook may be left as it is."""

    began: Callable[[Path], None] = lambda directory: None  # when its cells can be listed
    compiling: Callable[[Compilation], None] = lambda begun: None
    compiled: Callable[[Compilation], None] = lambda ended: None
    running: Callable[[Tally], None] = lambda tally: None  # once, before the first cell
    cell_done: Callable[[int, int], None] = lambda done, total: None
    timing: Callable[[str, int, int], None] = lambda what, done, total: None
    warning: Callable[[str], None] = lambda sentence: None
    note: Callable[[str], None] = lambda sentence: None
    copy: Path | None = None  # of the first cell's log, readable as it grows; of this machine alone


def _duration(job: CellJob) -> float:
    return float(job.config.clock.time(job.config.steps))


def _label(job: CellJob) -> str:
    return next((name.label for name in job.plan.cells if name.number == job.cell), "")


def _size(job: CellJob) -> int:
    """Return what a log takes so far [B]."""
    try:
        return job.path.stat().st_size
    except OSError:  # not yet made
        return 0
