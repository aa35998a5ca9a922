"""Kernels are deleted as far as the system allows, and what it does not let go is said."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from lavendersim.engine import kernel_store
from lavendersim.engine.compile_options import build
from lavendersim.runner.environment import delete_kernels, kernels


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with two kernels of this build and one of another."""
    monkeypatch.setattr(kernel_store, "directory", lambda: (tmp_path, ""))
    for name in (f"1-{build()}-a.kernel", f"2-{build()}-b.part", "3-another-c.kernel"):
        (tmp_path / name).write_bytes(bytes(10))
    return tmp_path


@pytest.mark.parametrize(("current", "count"), [(True, 2), (False, 1)])
def test_kernels_of_one_kind_are_deleted(store: Path, current: bool, count: int) -> None:
    found = delete_kernels(current)
    assert found.kernels == (count, 10 * count)
    assert (found.left, found.why) == ((0, 0), "")
    assert kernels(current) == (0, 0)
    assert kernels(not current).files == 3 - count


def test_of_a_disk_that_can_only_be_read_nothing_is_deleted_and_that_is_said(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(path: Path, missing_ok: bool = False) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))

    monkeypatch.setattr(Path, "unlink", refused)
    found = delete_kernels(current=True)
    assert found.kernels == (0, 0)
    assert found.left == (2, 20)
    assert found.why == os.strerror(errno.EROFS)
    assert len([*store.iterdir()]) == 3


def test_what_another_process_deletes_meanwhile_is_no_defect(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = kernel_store.kept_kernels

    def listed_then_gone() -> list[kernel_store.Kept]:
        found = listed()
        for each in found:
            os.unlink(each.path)
        return found

    monkeypatch.setattr(kernel_store, "kept_kernels", listed_then_gone)
    assert delete_kernels(current=True).why == ""
    assert [*store.iterdir()] == []
