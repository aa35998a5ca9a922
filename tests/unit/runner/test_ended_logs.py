"""What workers of a folder note of cells: measured, or closed, complete and whole, or to be run."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from shards_made import merged, shard

from lavendersim.errors import TraceError
from lavendersim.runner import Finished, cell, run
from lavendersim.runner.ended_logs import EndedLogs
from lavendersim.runner.merge import Missing, merge
from tests.runner.run_contents import contents
from tests.runner.small_configs import write


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    return write(tmp_path)


def killed_before_measuring(shard: Path, change: Callable[[dict[str, Any]], None]) -> Path:
    """Leave of a shard what a kill does between the close of its last log and its measures.

    change: of the line about that log. Returns the log.
    """
    notes = shard / "ended.jsonl"
    rows = [json.loads(line) for line in notes.read_text().splitlines()]
    last = rows[-1]["file"]
    kept = [row for row in rows if row["file"] != last or "measured" not in row]
    change(next(row for row in kept if row["file"] == last))
    # The line of the measures was begun.
    notes.write_text("".join(json.dumps(row) + "\n" for row in kept) + '{"file": "')
    return shard / "cells" / last


def nothing(row: dict[str, Any]) -> None:
    """Change nothing."""


def never(*_: object, **__: object) -> None:
    raise AssertionError("a cell was simulated again")


@pytest.mark.parametrize("part", [(1, 1), None], ids=["the same part", "a worker that joins"])
def test_a_closed_log_is_measured_and_not_run_again(
    drops: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, part: tuple[int, int] | None
) -> None:
    into = tmp_path / "shared"
    log = killed_before_measuring(shard(drops, into, (1, 1)).shard, nothing)
    assert log.name not in EndedLogs(into).read()
    with monkeypatch.context() as patch:
        patch.setattr(cell, "_simulate", never)
        again = shard(drops, into, part)
    assert (again.ran, again.measured, again.ended) == (0, 1, 3)
    assert log.name in EndedLogs(into).read()
    assert contents(merged(into)) == contents(run(drops, tmp_path / "whole").run)


def test_a_merge_measures_a_closed_log(
    drops: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = contents(run(drops, tmp_path / "whole").run)
    into = tmp_path / "shared"
    killed_before_measuring(shard(drops, into, (1, 1)).shard, nothing)
    monkeypatch.setattr(cell, "_simulate", never)
    assert contents(merged(into)) == whole


def cut(log: Path) -> None:
    log.write_bytes(log.read_bytes()[:-1])


def flip(log: Path) -> None:
    data = bytearray(log.read_bytes())
    data[len(data) // 2] ^= 1
    log.write_bytes(data)


@pytest.mark.parametrize("damage", [cut, flip, Path.unlink])
def test_a_closed_log_that_is_not_whole_is_run_again(
    drops: Path, tmp_path: Path, damage: Callable[[Path], None]
) -> None:
    into = tmp_path / "shared"
    damage(killed_before_measuring(shard(drops, into, (1, 1)).shard, nothing))
    assert isinstance(merge(into, tmp_path / "runs"), Missing)
    again = shard(drops, into)
    assert (again.ran, again.measured, again.ended) == (1, 0, 3)
    assert contents(merged(into)) == contents(run(drops, tmp_path / "whole").run)


def test_a_cell_that_was_interrupted_is_run_again(drops: Path, tmp_path: Path) -> None:
    def interrupt(row: dict[str, Any]) -> None:
        row["status"] = row["outcome"]["status"] = "interrupted by SIGTERM after step 3"

    into = tmp_path / "shared"
    killed_before_measuring(shard(drops, into, (1, 1)).shard, interrupt)
    assert isinstance(merge(into, tmp_path / "runs"), Missing)
    assert shard(drops, into).ran == 1
    assert isinstance(merge(into, tmp_path / "runs"), Finished)


def test_a_line_that_is_damaged_is_said(drops: Path, tmp_path: Path) -> None:
    def damage(row: dict[str, Any]) -> None:
        del row["accuracy"]

    into = tmp_path / "shared"
    log = killed_before_measuring(shard(drops, into, (1, 1)).shard, damage)
    ended = EndedLogs(into)
    ended.read()
    with pytest.raises(TraceError, match=r"ended\.jsonl: damaged"):
        ended.closed(log.name)
