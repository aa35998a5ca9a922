"""What killed processes left half written is removed, but not under a process that runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.runner.leftovers import remove_leftovers
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
