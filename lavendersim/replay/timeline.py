"""The timeline of simulated time: what is logged within `at_time` stands at that time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import rerun as rr

TIMELINE = "sim_time"


@contextmanager
def at_time(stream: rr.RecordingStream, nanoseconds: int) -> Iterator[None]:
    """What is logged within stands at this simulated time."""
    stream.set_time(TIMELINE, duration=np.timedelta64(nanoseconds, "ns"))
    try:
        yield
    finally:
        stream.reset_time()
