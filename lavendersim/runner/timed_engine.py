"""What the steps of an engine cost, sample by sample.

A sample is the same steps of the same motion every time: the engine is set back to the state in
which they begin. Time is the processor's own in this thread, where the system counts it finely:
what other programs take meanwhile is not in it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cached_property
from math import ceil
from statistics import median

from lavendersim.cell import CellConfig
from lavendersim.engine.engine import BLOCK_STEPS
from lavendersim.engine.memory import arrays_of
from lavendersim.engine.records import DIVERGED, RUNNING
from lavendersim.engine.spec import Spec
from lavendersim.scene.build import build

SAMPLE_NS = 5_000_000  # shortest sample: ten thousand times what reading the clock takes
FINE = 1e-6  # [s] resolution of a clock that times a sample to a thousandth or better
# Rows are written before they are read: they need not be set back.
_ROWS = ("log",)


def clock() -> tuple[str, Callable[[], int]]:
    """Return the name of the clock that samples are taken with, and the clock [ns]."""
    if time.get_clock_info("thread_time").resolution <= FINE:
        return "thread_time", time.thread_time_ns
    return "perf_counter", time.perf_counter_ns  # where thread time is a system tick


class Diverged(Exception):  # noqa: N818 - an outcome of an engine that lacks an effect, no error
    """The engine's bodies fly apart within the steps that were to be timed."""


class Timed:
    """An engine that does the same steps again and again."""

    def __init__(
        self,
        config: CellConfig,
        spec: Spec,
        first: int,
        steps: int,
        now: Callable[[], int] | None = None,
        shortest: int = SAMPLE_NS,
    ) -> None:
        """Take the engine to step `first`; `steps` after it are timed. Raises Diverged.

        shortest: a sample repeats the steps for so long, at least [ns].
        """
        self.spec, self.steps = spec, steps
        self._now = now or clock()[1]
        self.engine = build(config, spec).engine(spec, min(steps, BLOCK_STEPS))
        self._run(first)
        self.engine.take_rows()
        self._begin_state = dict(vars(self.engine))
        self._contents = [
            (array, array.copy())
            for name, value in self._begin_state.items()
            if name not in _ROWS
            for array in arrays_of(value)
        ]
        self.starts = max(1, ceil(shortest / max(1, self._once())))

    def set_back(self) -> None:
        """Return to the state in which the timed steps begin."""
        vars(self.engine).update(self._begin_state)
        for array, content in self._contents:
            array[...] = content

    def sample(self) -> float:
        """Return the cost of a step [ns], the median over enough runs of the timed steps."""
        return median(self._once() for _ in range(self.starts)) / self.steps

    def _once(self) -> int:
        """Return the time of the timed steps [ns]."""
        self.set_back()
        begin = self._now()
        self._run(self.steps)
        return self._now() - begin

    def _run(self, steps: int) -> None:
        target = int(self.engine.counters["step"][0]) + steps
        while (
            status := self.engine.advance(target - int(self.engine.counters["step"][0]))
        ) != RUNNING:
            if status == DIVERGED:
                raise Diverged
            self.engine.take_rows()

    @property
    def contacts(self) -> float:
        """The mean number of contacts a step."""
        return self._observed[0]

    @property
    def motion(self) -> bytes:
        """The bits of where bodies end."""
        return self._observed[1]

    @cached_property
    def _observed(self) -> tuple[float, bytes]:
        self.set_back()
        contacts = 0
        for _ in range(self.steps):
            self._run(1)
            contacts += int(self.engine.counters["contacts"][0])
        ends = [self.engine.bodies[axis] for axis in "xyz"]
        ends += [self.engine.velocities[axis] for axis in ("vx", "vy", "vz")]
        # Adding 0.0 makes -0.0 the 0.0 that it equals.
        return contacts / self.steps, b"".join((column + 0.0).tobytes() for column in ends)
