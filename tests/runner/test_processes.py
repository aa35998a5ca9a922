"""Cells are run in other processes where that is worth it, and here where it is not."""

from __future__ import annotations

import os
import pickle
from pathlib import Path
from typing import Any

import pytest
from small_configs import write

import lavendersim
from lavendersim.runner import executor

Processes = list[int]


class Given(Exception):  # noqa: N818 - it is no error
    """What other processes would have been given, before any of them is started."""


def given(config: Path, root: Path, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return the bytes of each cell that other processes are given of a sweep."""

    def work(function: Any, tasks: Any, *arguments: Any) -> Any:
        raise Given([len(pickle.dumps(job)) for batch in tasks for job in batch])

    monkeypatch.setattr(executor, "work", work)
    monkeypatch.setattr(executor, "WORTH_PROCESSES", 0.0)
    with pytest.raises(Given) as end:
        lavendersim.run(config, root=root, jobs=2)
    sizes: list[int] = end.value.args[0]
    return sizes


def test_a_task_of_another_process_is_no_larger_in_a_larger_sweep(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else to hand out all of a sweep would take the square of its cells."""
    sizes = {}
    for count, here in ((4, 1), (64, 2)):  # of many short cells the second tells how short
        values = ", ".join(f"{0.1 + k / 100:.2f}" for k in range(count))
        folder = tmp_path / str(count)
        folder.mkdir()
        config = write(folder)
        text = config.read_text()
        assert "[0.2, 0.5, 0.8]" in text
        config.write_text(text.replace("[0.2, 0.5, 0.8]", f"[{values}]"))
        found = given(config, folder / "runs", monkeypatch)
        assert len(found) == count - here
        sizes[count] = max(found) - len(config.read_text())  # which every log has attached
    # Of the cells a log names at most three; their labels may be longer by some digits.
    assert sizes[64] <= sizes[4] + 1000


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
