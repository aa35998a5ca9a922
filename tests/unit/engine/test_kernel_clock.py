"""Kernels read the clock of the system."""

from __future__ import annotations

import time

import pytest

from lavendersim.engine import kernel_clock
from lavendersim.engine.compile import compiling, inner
from lavendersim.engine.kernel_clock import CLOCK, nanoseconds


@pytest.mark.skipif(CLOCK is None, reason="the system has no such clock")
def test_the_clock_is_that_of_the_system() -> None:
    @inner
    def now():
        return nanoseconds()

    with compiling():
        now()
    before = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
    between = now()
    assert before <= between <= time.clock_gettime_ns(time.CLOCK_MONOTONIC)


def test_without_one_it_stands_still(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel_clock, "CLOCK", None)

    @inner
    def never():
        return nanoseconds() + 1

    with compiling():
        assert never() == 1
