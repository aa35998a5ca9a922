"""What a packed contact's visit moves, beside what the machine's memory gives."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lavendersim.engine.solvers.packed.lane_memory import STRIDE
from lavendersim.engine.solvers.packed.layout import begins
from lavendersim.engine.spec import Spec
from lavendersim.runner.timed_engine import clock

NUMBER = 8  # bytes
BLOCK = 128 * 2**20  # bytes that are read: more than caches hold
TIMES = 5


class Traffic(NamedTuple):
    """Bytes that one visit of a packed contact moves."""

    rows: int  # read: its fields, and where its two bodies are
    bodies: int  # read, and written again: the states of both

    def as_data(self) -> dict[str, int]:
        """Return them as plain data."""
        return dict(self._asdict())


def traffic_of(spec: Spec) -> Traffic:
    """Return what sweeps over packed contacts of an engine move by visit."""
    return Traffic(NUMBER * (begins(spec).end + 2), NUMBER * 2 * STRIDE)


def memory_bandwidth() -> float:
    """Return how fast one thread reads an array that no cache holds, at best [GB/s]."""
    numbers, now, best = np.ones(BLOCK // NUMBER), clock()[1], np.inf
    for _ in range(TIMES):
        begin = now()
        numbers.max()
        best = min(best, now() - begin)
    return BLOCK / best
