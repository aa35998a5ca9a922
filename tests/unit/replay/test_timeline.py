"""What is logged at a time stands there, and what is logged behind it does not."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.replay.timeline import TIMELINE, at_time


class Stream:
    """Notes which time is set and when it ends."""

    def __init__(self) -> None:
        self.said: list[object] = []

    def set_time(self, timeline: str, *, duration: np.timedelta64) -> None:
        """Set a time."""
        self.said.append((timeline, duration))

    def reset_time(self) -> None:
        """Set none."""
        self.said.append("reset")


def test_times_are_whole_nanoseconds() -> None:
    stream = Stream()
    with at_time(stream, 2**53 + 1):  # type: ignore[arg-type]
        assert stream.said == [(TIMELINE, np.timedelta64(2**53 + 1, "ns"))]
    assert stream.said[-1] == "reset"


def test_a_time_ends_with_an_error() -> None:
    stream = Stream()
    with pytest.raises(ZeroDivisionError), at_time(stream, 5):  # type: ignore[arg-type]
        raise ZeroDivisionError
    assert stream.said[-1] == "reset"
