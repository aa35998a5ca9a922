"""Cells are run in other processes where that is worth it, and here where it is not."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from small_configs import write

import lavendersim
from lavendersim.runner import executor

Processes = list[int]


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> Processes:
    """Keep how many cells other processes are given at a time."""
    counts: Processes = []
    real = executor.work

    def work(function: Any, tasks: Any, *arguments: Any) -> Any:
        counts.append(len(tasks))
        return real(function, tasks, *arguments)

    monkeypatch.setattr(executor, "work", work)
    return counts


def test_a_small_sweep_starts_no_process(
    tmp_path: Path, started: Processes, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = write(tmp_path)
    lavendersim.run(config, root=tmp_path / "warm")  # kernels are no matter of this
    monkeypatch.setattr(executor, "WORTH_PROCESSES", 60.0)
    finished = lavendersim.run(config, root=tmp_path / "runs", jobs=2)
    assert len(finished.outcomes) > 2
    assert started == []


def test_a_long_one_starts_them_after_the_first_cell(tmp_path: Path, started: Processes) -> None:
    config = write(tmp_path)
    lavendersim.run(config, root=tmp_path / "warm")
    finished = lavendersim.run(config, root=tmp_path / "runs", jobs=2)
    logs = {cell.path for cell in finished.run.cells}
    assert started == [len(logs) - 1]
    assert all(os.path.getsize(log) for log in logs)
