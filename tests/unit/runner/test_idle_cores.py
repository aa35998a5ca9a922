"""Cores that are idle, by what Linux counts of each."""

from __future__ import annotations

import os
from math import inf
from pathlib import Path

import pytest

from lavendersim.runner.idle_cores import LEAST, IdleCores, idle_time

TICK = os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 100  # [1/s]
pytestmark = pytest.mark.skipif(not hasattr(os, "sched_getaffinity"), reason="Linux counts")


def statistics(*idle: int) -> str:
    """Return what Linux says where cores were idle for so many ticks, and waited for 3 more."""
    total = f"cpu  9 9 9 {sum(idle)} 9 0 0 0 0 0"
    cores = [f"cpu{core} 5 6 7 {ticks} 3 0 0 0 0 0" for core, ticks in enumerate(idle)]
    return "\n".join([total, *cores, "intr 1 2 3", ""])


def test_only_cores_that_the_process_may_use_count() -> None:
    text = statistics(100, 200, 400)
    assert idle_time(text, {0, 2}, is_nice=True) == (103 + 403) / TICK
    assert (
        idle_time(text, {0, 2}, is_nice=False) == (103 + 403 + 2 * 6) / TICK
    )  # nice ones give way
    with pytest.raises(ValueError, match="none of these cores"):
        idle_time(text, {7}, is_nice=True)


def test_a_core_that_was_idle_half_of_the_time_is_half_a_core(tmp_path: Path) -> None:
    own, now = max(os.sched_getaffinity(0)), [5.0]
    file = tmp_path / "stat"
    file.write_text(statistics(*[1000] * (own + 1)))
    cores = IdleCores(file, lambda: now[0])
    assert cores.idle() == inf  # nothing was counted
    now[0] += 2.0
    file.write_text(statistics(*[1000] * own, 1000 + TICK))
    assert cores.idle() == 0.5
    now[0] += 0.9 * LEAST
    file.write_text(statistics(*[1000] * own, 1000 + 2 * TICK))
    assert cores.idle() == 0.5  # too soon to tell


@pytest.mark.parametrize("text", [None, "", "cpu0 a a a a a a"])
def test_where_nobody_tells_all_are_idle(tmp_path: Path, text: str | None) -> None:
    now, file = [0.0], tmp_path / "stat"
    if text is not None:
        file.write_text(text)
    cores = IdleCores(file, lambda: now[0])
    now[0] += 1.0
    assert cores.idle() == inf
