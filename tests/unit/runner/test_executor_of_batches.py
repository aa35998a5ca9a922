"""Short cells of a sweep are run in batches, whose signals and logs are those of single cells."""

from __future__ import annotations

import os
import signal
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from lavendersim import open_trace
from lavendersim.cell import CellEngine
from lavendersim.experiment import load_experiment_text
from lavendersim.runner import Progress, executor
from lavendersim.runner.accuracy import Accuracy
from lavendersim.runner.cell import CellJob, failed, run_and_measure
from lavendersim.runner.cell_jobs import prepare
from lavendersim.runner.cell_outcome import CellOutcome
from lavendersim.runner.executor import SHORT, TOGETHER
from lavendersim.runner.interruption import Interrupted, handled
from lavendersim.runner.run_index import ended_rows
from tests.runner.small_configs import DROPS

MUJOCO = CellEngine(name="mujoco", settings={})


def jobs_of(folder: Path, durations: Sequence[float], more: str = "") -> list[CellJob]:
    """Return cells of these durations."""
    swept = "{path: duration, values: " + str([*durations]) + "}"
    text = DROPS.partition("sweep:")[0] + f"sweep: {{duration: {swept}}}\nalways: {{}}\n{more}"
    (folder / "cells").mkdir(parents=True)
    return prepare(load_experiment_text(text, "drops.yaml")).jobs(folder)


def lengths(jobs: list[CellJob], most: int) -> list[int]:
    return [len(batch) for batch in executor._batches(jobs, most)]


def test_short_cells_that_follow_each_other_go_together(tmp_path: Path) -> None:
    (job,) = jobs_of(tmp_path / "one", [0.1])
    long = 1.01 * SHORT / 2 * float(job.config.numerics.timestep)  # [s] of two bodies
    jobs = jobs_of(tmp_path / "six", [0.1, 0.2, 0.3, long, 0.4, 0.5])
    assert lengths(jobs, TOGETHER) == [3, 1, 2]
    assert lengths(jobs, 2) == [2, 1, 1, 2]
    assert lengths(jobs, 0) == [1] * 6  # a sweep of too few for every process to have several
    assert [one for batch in executor._batches(jobs, 2) for one in batch] == jobs


@pytest.mark.parametrize("more", ["record: {residuals: all}\n", "record: {problems: every 9}\n"])
def test_cells_of_large_logs_are_run_alone(tmp_path: Path, more: str) -> None:
    assert lengths(jobs_of(tmp_path, [0.1, 0.2], more), TOGETHER) == [1, 1]


def test_a_batch_writes_the_bytes_of_its_cells_alone(tmp_path: Path) -> None:
    together, alone = (jobs_of(tmp_path / name, [0.1, 0.3, 0.2]) for name in ("all", "each"))
    ended = run_and_measure(together)
    for job, other, one in zip(together, alone, ended, strict=True):
        (single,) = run_and_measure([other])
        assert job.path.read_bytes() == other.path.read_bytes()
        assert repr(single.measured) == repr(one.measured)  # what is not measured is no number
        assert single.outcome.log == one.outcome.log
    assert len(ended_rows(tmp_path / "all")) == 3


def test_cells_of_other_engines_alone_may_have_several_processes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """None of them is the first of a plan, so nothing is known of the time they take."""
    jobs = [
        job._replace(config=job.config.model_copy(update={"engine": MUJOCO}))
        for job in jobs_of(tmp_path, [0.1, 0.2])
    ]
    monkeypatch.setattr(executor, "run_and_measure", lambda batch, began: [failed(*batch, "died")])
    monkeypatch.setattr(executor, "WORTH_PROCESSES", 1e9)
    assert [job for job, _ in executor.outcomes_of(jobs, 2, Progress())] == jobs


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_a_signal_closes_the_log_of_every_cell_of_a_batch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It comes with the first call: each cell has the steps of that."""
    from lavendersim.runner import cell

    monkeypatch.setattr("lavendersim.runner.call_length.MOST", 20)
    calls: list[int] = []
    real = cell.advance_together

    def advance(engines: Any, steps: Any, **how: Any) -> Any:
        calls.append(len(engines))
        os.kill(os.getpid(), signal.SIGTERM)
        return real(engines, steps, **how)

    jobs = jobs_of(tmp_path, [0.1, 0.2, 0.3])
    monkeypatch.setattr(cell, "advance_together", advance)
    with handled(), pytest.raises(Interrupted, match="SIGTERM"):
        run_and_measure(jobs)
    assert calls == [3]
    for job in jobs:
        trace = open_trace(job.path, allow_incomplete=True)
        assert trace.status.startswith("interrupted by SIGTERM after step 10")
        assert len(trace.step) == 11
    rows = ended_rows(tmp_path)
    assert {row["status"][:11] for row in rows.values()} == {"interrupted"}
    assert not any("measured" in row for row in rows.values())


def test_a_cold_first_cell_does_not_keep_the_others_from_batches(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It loads what all have in common; one more is run here, and tells that they are brief."""
    given: list[int] = []
    spent: list[float] = [0.0]

    def run_here(batch: list[CellJob], began: Any) -> list[Any]:
        spent.append(spent[-1] + (1.0 if len(spent) == 1 else 0.001))
        return [failed(*batch, "died")]

    def work(function: Any, batches: Any, *arguments: Any) -> Any:
        given.extend(map(len, batches))
        return [(batch, [failed(job, "died") for job in batch]) for batch in batches]

    count = 2 * 2 * executor.BATCHES + 2
    jobs = jobs_of(tmp_path, [round(0.1 + k / 240, 4) for k in range(count)])
    monkeypatch.setattr(executor, "run_and_measure", run_here)
    monkeypatch.setattr(executor, "process_time", lambda: spent[-1])
    monkeypatch.setattr(executor, "work", work)
    assert len([*executor.outcomes_of(jobs, 2, Progress())]) == count
    assert given == [2] * (2 * executor.BATCHES)
    given.clear()
    spent[1:] = []
    left = jobs[:-1]
    assert len([*executor.outcomes_of(left, 2, Progress())]) == count - 1
    assert given == [1] * (count - 2)  # too few for batches: no cell is run here to find out


def test_a_cold_first_cell_starts_no_processes_for_brief_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It took a second; the 40 others take 0.04 s together, less than to start a process."""
    spent: list[float] = [0.0]

    def run_here(batch: list[CellJob], began: Any) -> list[Any]:
        spent.append(spent[-1] + (1.0 if len(spent) == 1 else 0.001 * len(batch)))
        return [failed(job, "died") for job in batch]

    jobs = jobs_of(tmp_path, [round(0.1 + k / 240, 4) for k in range(41)])
    monkeypatch.setattr(executor, "run_and_measure", run_here)
    monkeypatch.setattr(executor, "process_time", lambda: spent[-1])
    monkeypatch.setattr(executor, "WORTH_PROCESSES", 4.0)
    monkeypatch.setattr(executor, "work", lambda *what: pytest.fail("a process was started"))
    assert len([*executor.outcomes_of(jobs, 2, Progress())]) == 41


def test_a_kernel_that_waited_for_the_processor_takes_no_more_than_there_was() -> None:
    """Loaded in 3 s by the wall, of a second that the processor worked here: 0.2 s are left."""
    outcome = CellOutcome(0, "complete", 9, 3 * 10**9, 10**8, 10**8, Accuracy())
    assert executor._without_compiling(1.0, [outcome]) == 0.2
    assert executor._without_compiling(0.1, [outcome]) == 0.1
    assert executor._without_compiling(4.0, [outcome]) == 1.0
