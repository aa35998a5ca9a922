"""What it takes to compile kernels that lay out a log is compiling: logging costs the same cold."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from lavendersim import run
from lavendersim.engine import compile as kernels
from lavendersim.runner import cell
from lavendersim.trace.writer import TraceWriter
from tests.drop_config import DROP, SIX

SECOND = 10**9  # [ns]


class Clock:
    """A clock that goes on by 1 ns where it is read, and by a second where something compiles."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 0
        for module in (kernels, cell):
            monkeypatch.setattr(module, "perf_counter_ns", self)

    def __call__(self) -> int:
        self.now += 1
        return self.now


def test_kernels_of_the_log_that_are_compiled_are_no_cost_of_logging(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock, append = Clock(monkeypatch), TraceWriter.append

    def compiled_first(self: TraceWriter, *arguments: Any) -> Any:
        with kernels.compiling():
            clock.now += SECOND
        return append(self, *arguments)

    monkeypatch.setattr(TraceWriter, "append", compiled_first)
    config = tmp_path / "drop.yaml"
    config.write_text(DROP)
    [found] = run(config, tmp_path / "runs").run.results().cells
    assert found.compile_s >= 1.0
    # The clock is read some hundred times.
    assert found.steps * found.logging_us_per_step * 1e-6 < 1e-3


def test_cells_that_are_simulated_together_have_their_own_kernels_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What one of them compiles is there for the others: none of these waited for it."""
    clock, close, closed = Clock(monkeypatch), TraceWriter.close, []

    def compiled_once(self: TraceWriter, *arguments: Any) -> Any:
        closed.append(self)
        if len(closed) == 3:  # the first two of a plan are simulated alone
            with kernels.compiling():
                clock.now += SECOND
        return close(self, *arguments)

    monkeypatch.setattr(TraceWriter, "close", compiled_once)
    config = tmp_path / "six.yaml"
    config.write_text("question: How high?\nexpected: e^2 h.\n" + SIX)
    cells = run(config, tmp_path / "runs").run.results().cells
    assert len(cells) == 6
    assert sorted(one.compile_s >= 1.0 for one in cells) == [False] * 5 + [True]


def test_what_compiles_within_what_compiles_is_counted_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, before = Clock(monkeypatch), kernels.compiled_ns()
    with kernels.compiling(), kernels.compiling():
        clock.now += SECOND
    assert SECOND <= kernels.compiled_ns() - before < SECOND + 10
