"""Cells run by workers of others: the same run, whoever dies, shared folder or none."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from executors import Here

from lavendersim.errors import UsageError
from lavendersim.runner import Progress, remote, run
from tests.runner.run_contents import contents
from tests.runner.small_configs import write


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    return write(tmp_path)


def elsewhere(task: remote.RemoteTask) -> remote.RemoteResult:
    """Run a cell as on a machine that does not see the folder of the run."""
    return remote.run_there(task._replace(sign=".another.sign"))


class Restarted(Here):
    """Its scheduler is lost so often: two cells are cancelled by that, of one nothing is heard."""

    def __init__(self, restarts: int) -> None:
        super().__init__()
        self._silent = 3 * restarts

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        if self.given >= self._silent:
            return super().submit(fn, *args, **kwargs)
        self.given += 1
        future: Future[Any] = Future()
        if self.given % 3:
            future.cancel()
            future.set_running_or_notify_cancel()
        return future


@pytest.mark.parametrize("function", [None, elsewhere], ids=["shared folder", "no shared folder"])
def test_an_executor_leaves_the_run_that_processes_leave(
    drops: Path, tmp_path: Path, function: Callable[..., Any] | None
) -> None:
    whole = run(drops, tmp_path / "whole")
    found = run(drops, tmp_path / "runs", executor=Here(function=function))
    assert contents(found.run) == contents(whole.run)
    assert found.good


def test_with_a_shared_folder_no_log_travels(drops: Path, tmp_path: Path) -> None:
    came: list[remote.RemoteResult] = []

    def noted(task: remote.RemoteTask) -> remote.RemoteResult:
        came.append(remote.run_there(task))
        return came[-1]

    run(drops, tmp_path / "runs", executor=Here(function=noted))
    assert [one.log for one in came] == [None] * 3


def test_a_cell_whose_worker_is_lost_is_run_once_more(drops: Path, tmp_path: Path) -> None:
    said: list[str] = []
    executor = Here(lost=1)
    found = run(drops, tmp_path / "runs", progress=Progress(warning=said.append), executor=executor)
    assert executor.given == 4
    assert said == [
        "the worker of cell e=0.2 was lost (RuntimeError); the cell is run once more",
    ]
    assert contents(found.run) == contents(run(drops, tmp_path / "whole").run)


def test_what_a_killed_worker_left_half_written_goes_with_the_run(
    drops: Path, tmp_path: Path
) -> None:
    def half(task: remote.RemoteTask) -> remote.RemoteResult:
        (task.job.path.parent / f".{task.job.path.name}.1.unfinished").touch()
        return remote.run_there(task)

    found = run(drops, tmp_path / "runs", executor=Here(function=half))
    assert contents(found.run) == contents(run(drops, tmp_path / "whole").run)


def test_a_cell_whose_workers_are_lost_both_times_has_failed(drops: Path, tmp_path: Path) -> None:
    said: list[str] = []
    shown = Progress(warning=said.append)
    found = run(drops, tmp_path / "runs", progress=shown, executor=Here(lost=100))
    for label in ("e=0.2", "e=0.5", "e=0.8"):
        lost = f"the worker of cell {label} was lost (RuntimeError)"
        assert f"{lost} again; the cell is given up" in said
    status = "failed: its process was lost (RuntimeError), both times"
    assert [cell.status for cell in found.run.cells] == [status] * 3
    assert not found.good


def test_what_a_lost_scheduler_had_is_given_to_it_again(
    drops: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(remote, "SETTLED", 0.0)
    said: list[str] = []
    progress = Progress(warning=said.append)
    found = run(drops, tmp_path / "runs", progress=progress, executor=Restarted(2))
    assert said == ["the executor lost its scheduler; 3 cells are given to it again"] * 2
    assert contents(found.run) == contents(run(drops, tmp_path / "whole").run)
    with pytest.raises(UsageError, match="lost its scheduler 6 times"):
        run(drops, tmp_path / "runs", executor=Restarted(100))


def test_an_executor_that_takes_no_more_is_said_and_the_run_goes_on_later(
    drops: Path, tmp_path: Path
) -> None:
    pool = ProcessPoolExecutor(1)
    pool.shutdown()
    with pytest.raises(UsageError, match="the executor takes no more cells: cannot schedule"):
        run(drops, tmp_path / "runs", executor=pool)
    found = run(drops, tmp_path / "runs", resume=True)
    assert contents(found.run) == contents(run(drops, tmp_path / "whole").run)
