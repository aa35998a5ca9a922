"""DONE is the last to reach the disk, and a call that fails leaves no run that says it is done."""

from __future__ import annotations

import errno
import itertools
import os
from pathlib import Path

import pytest
from small_configs import write

import lavendersim
from lavendersim.runner import list_runs, open_run
from lavendersim.runner.verification import problems_of
from lavendersim.trace.container import Container
from tests.file_calls import FileCalls

TABLES = ("cells.json", "results.json", "results.csv", "config.yaml", "resolved.json", "env.json")


def test_all_of_a_run_is_flushed_before_done_and_done_before_latest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = tmp_path / "runs"
    config = write(tmp_path)
    lavendersim.run(config, root=tmp_path / "warm")  # kernels are no matter of this
    calls = FileCalls().watch(monkeypatch)
    run = lavendersim.run(config, root=root).run
    done = run.path / "DONE"
    logs = {cell.path for cell in run.cells}
    for file in (*logs, *(run.path / name for name in TABLES)):
        if file not in logs:
            assert calls.at("replace", file) < calls.at("fsync", file)
        assert calls.at("fsync", file) < calls.at("replace", done)
    order = [
        *(("fsync", run.path / "cells"), ("fsync", calls.source[done]), ("replace", done)),
        *(("fsync", run.path), ("fsync", root)),
    ]
    assert [calls.at(*call) for call in order] == sorted(calls.at(*call) for call in order)
    # nothing is flushed cell by cell: a sweep of thousands would wait for the disk
    assert sum(call.name == "fsync" for call in calls.made) <= len(logs) + len(TABLES) + 6


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO])
def test_whichever_call_fails_no_run_says_that_it_is_done_and_is_not(
    tmp_path: Path, error: int
) -> None:
    root = tmp_path / "runs"
    config = write(tmp_path)
    earlier = lavendersim.run(config, root=root).run
    for number in itertools.count():
        calls = FileCalls(number, error)
        with pytest.MonkeyPatch.context() as patch:
            calls.watch(patch)
            try:
                lavendersim.run(config, root=root)
            except OSError as failed:
                found = failed.errno
            else:
                break
        assert found == error
        for run in list_runs(root):
            assert not run.finished or [*problems_of(run)] == []
        assert open_run(earlier.path).results()["passed"]
        assert (root / "latest").resolve() in {run.path.resolve() for run in list_runs(root)}
        assert open_run(None, root).finished
        assert not [*root.rglob("*unfinished*")]
    assert number > 20


def test_a_disk_that_is_full_while_a_log_is_written_ends_the_run_with_its_index(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = tmp_path / "runs"
    written = 0
    real = Container._write

    def full(container: Container, data: bytes) -> None:
        nonlocal written
        written += len(data)
        if written > 60_000:  # in the second of three logs
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(container, data)

    monkeypatch.setattr(Container, "_write", full)
    with pytest.raises(OSError, match="No space left"):
        lavendersim.run(write(tmp_path), root=root)
    (run,) = list_runs(root)
    assert not run.finished
    assert [cell.status for cell in run.cells] == ["complete", "pending", "pending"]
    assert run.cells[0].damage() == ""
