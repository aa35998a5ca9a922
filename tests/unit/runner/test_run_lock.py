"""One holder of a run's directory at a time; the lock leaves nothing behind."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from lavendersim.errors import UsageError
from lavendersim.runner.run_lock import run_lock


def test_a_second_one_is_kept_out_until_the_first_has_ended(tmp_path: Path) -> None:
    with run_lock(tmp_path):
        with (
            pytest.raises(UsageError, match="another process runs its cells"),
            run_lock(tmp_path),
        ):
            raise AssertionError("it was let in")
        # Who was kept out has not opened the door for a third.
        with pytest.raises(UsageError), run_lock(tmp_path):
            raise AssertionError("it was let in")
    with run_lock(tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []


def test_it_ends_with_an_error_inside(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), run_lock(tmp_path):
        raise ZeroDivisionError
    with run_lock(tmp_path):
        pass


def test_other_directories_are_free(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "other").mkdir()
    before = len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0
    with run_lock(tmp_path / "one"), run_lock(tmp_path / "other"):
        pass
    after = len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0
    assert after == before
