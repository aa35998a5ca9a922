"""What killed processes left half written is removed, but not under a process that runs."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from lavendersim.runner.leftovers import clean, remove_leftovers
from lavendersim.runner.run_lock import run_lock

LEFT = (".results.1-1.unfinished.json", "cells/.a.mcap.0f.unfinished")


@pytest.fixture
def runs(tmp_path: Path) -> Path:
    for name in ("dead", "locked", "finished"):
        (tmp_path / name / "cells").mkdir(parents=True)
        (tmp_path / name / "cells.json").write_text("{}")
        for left in LEFT:
            (tmp_path / name / left).write_text("half")
    (tmp_path / "finished" / "DONE").touch()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / LEFT[0]).write_text("of somebody else")
    (tmp_path / "latest").symlink_to("locked")
    return tmp_path


def left_in(runs: Path) -> dict[str, int]:
    return {path.name: len([*path.rglob(".*")]) for path in runs.iterdir() if not path.is_symlink()}


def test_what_is_half_written_in_dead_runs_is_removed(runs: Path) -> None:
    with run_lock(runs / "locked"):
        remove_leftovers(runs)
    assert left_in(runs) == {"dead": 0, "locked": 2, "finished": 2, "other": 1}
    assert (runs / "dead" / "cells.json").exists()
    remove_leftovers(runs)
    assert left_in(runs)["locked"] == 0


@pytest.fixture(scope="module")
def dead() -> int:
    """The number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_clean_removes_all_that_the_dead_left_and_nothing_of_the_living(
    runs: Path, dead: int
) -> None:
    """A verb that draws in a finished run takes no lock: the name of its file tells."""
    left = [
        *(f"finished/.figure.{dead}-0.unfinished.png", "finished/cells/a.mcap.recovering"),
        *(f".latest-{dead}", f".latest.{dead}-3.unfinished", "dead/cells/.0f.sign"),
    ]
    kept = [
        *(f"finished/.figure.{os.getpid()}-0.unfinished.png", f".latest-{os.getpid()}"),
        *("finished/cells/a.mcap", "dead/cells/b.mcap"),
    ]
    for name in (*left, *kept):
        (runs / name).write_bytes(bytes(1000))
    removed = runs / f".removed-{dead}-run" / "cells"
    removed.mkdir(parents=True)
    (removed / "a.mcap").write_bytes(bytes(1000))
    being_removed = runs / f".removed-{os.getpid()}-run"
    being_removed.mkdir()
    with run_lock(runs / "locked"):
        found = clean(runs)
    # The fixture's runs have two files of 4 bytes each; of the finished one the first is of process
    # 1, which always runs. One file stands in the run that was being removed.
    assert found == (len(left) + 1 + 3, 1000 * (len(left) + 1) + 4 * 3)
    assert not any((runs / name).exists() for name in left)
    assert not removed.parent.exists()
    assert all((runs / name).exists() for name in kept)
    assert being_removed.exists()
    assert left_in(runs)["locked"] == 2
    assert left_in(runs)["other"] == 1
    assert (runs / "latest").is_symlink()
    assert clean(runs).files == 2  # what the lock kept
    assert clean(runs).files == 0


def test_clean_of_no_folder_removes_nothing(tmp_path: Path) -> None:
    assert clean(tmp_path / "runs") == (0, 0)
