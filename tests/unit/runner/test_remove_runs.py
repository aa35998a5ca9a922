"""Removed runs leave nothing behind, and `latest` names a run that there is."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.errors import UsageError
from lavendersim.runner.remove_runs import REMOVED, remove, remove_leftovers
from lavendersim.runner.run_directory import LATEST, Run
from lavendersim.runner.run_lock import run_lock


def made(root: Path, *names: str) -> list[Run]:
    """Return directories of runs."""
    for name in names:
        (root / name / "cells").mkdir(parents=True)
        (root / name / "cells" / "a.mcap").write_text("log")
    return [Run(root / name) for name in names]


def test_runs_that_are_removed_are_gone_and_the_others_stay(tmp_path: Path) -> None:
    one, two, three = made(tmp_path, "one", "two", "three")
    assert remove([one, three], tmp_path) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["two"]
    assert (two.path / "cells" / "a.mcap").exists()


def test_a_run_that_is_worked_in_stays_and_those_before_it_are_gone(tmp_path: Path) -> None:
    one, two, three = made(tmp_path, "one", "two", "three")
    with run_lock(two.path), pytest.raises(UsageError, match="another process runs its cells"):
        remove([one, two, three], tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["three", "two"]


def test_latest_that_names_a_removed_run_is_gone(tmp_path: Path) -> None:
    (one,) = made(tmp_path, "one")
    (tmp_path / LATEST).symlink_to("one")
    remove([one], tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_a_killed_removal_left_is_no_run_and_is_removed(tmp_path: Path) -> None:
    made(tmp_path, "one", f"{REMOVED}7-two")
    remove_leftovers(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["one"]
