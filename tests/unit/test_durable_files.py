"""A file is flushed before it takes its name, its folder after; what fails leaves the earlier."""

from __future__ import annotations

import errno
import itertools
from collections.abc import Callable
from pathlib import Path

import pytest

from lavendersim import durable_files
from lavendersim.durable_files import (
    MOST_BYTES,
    flush_tree,
    path_name,
    write_together,
    write_whole,
    written_aside,
)
from tests.file_calls import FileCalls


def by_one_call(path: Path, content: bytes) -> None:
    write_whole(path, content)


def by_a_library(path: Path, content: bytes) -> None:
    with written_aside(path) as unfinished:
        assert unfinished.suffix == path.suffix
        unfinished.write_bytes(content)


@pytest.mark.parametrize("write", [by_one_call, by_a_library])
def test_flush_rename_flush_stand_in_this_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, write: Callable[[Path, bytes], None]
) -> None:
    path = tmp_path / "folder" / "table.json"
    calls = FileCalls().watch(monkeypatch)
    write(path, b"content")
    assert path.read_bytes() == b"content"
    aside = calls.source[path]
    assert aside.parent == path.parent
    order = [("fsync", aside), ("replace", path), ("fsync", path.parent)]
    assert [calls.at(*call) for call in order] == sorted(calls.at(*call) for call in order)
    assert [*path.parent.iterdir()] == [path]


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO])
@pytest.mark.parametrize("write", [by_one_call, by_a_library])
def test_the_earlier_file_stays_whichever_call_fails(
    tmp_path: Path, write: Callable[[Path, bytes], None], error: int
) -> None:
    path = tmp_path / "table.json"
    for number in itertools.count():
        path.write_bytes(b"earlier")
        calls = FileCalls(number, error)
        with pytest.MonkeyPatch.context() as patch:
            calls.watch(patch)
            try:
                write(path, b"new")
            except OSError as failed:
                found = failed.errno
            else:
                break
        assert found == error
        # It is whole whenever the call failed; the new one only if that was after the rename.
        renamed = any(call.name == "replace" for call in calls.made[:number])
        assert path.read_bytes() == (b"new" if renamed else b"earlier")
        assert [*tmp_path.iterdir()] == [path]
    assert number >= 4


def test_of_several_files_none_takes_its_name_before_all_are_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = [tmp_path / name for name in ("a.png", "a.svg")]
    calls = FileCalls().watch(monkeypatch)
    write_together(dict.fromkeys(paths, "é"))
    assert all(path.read_text(encoding="utf-8") == "é" for path in paths)
    flushed = max(calls.at("fsync", calls.source[path]) for path in paths)
    assert flushed < min(calls.at("replace", path) for path in paths)
    assert calls.at("fsync", tmp_path) == len(calls.made) - 1


def test_a_file_that_exists_is_not_written_where_it_must_be_new(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    path.write_bytes(b"earlier")
    with pytest.raises(FileExistsError), written_aside(path, anew=True) as unfinished:
        unfinished.write_bytes(b"new")
    assert path.read_bytes() == b"earlier"
    assert [*tmp_path.iterdir()] == [path]


@pytest.mark.parametrize("count", [3, durable_files.FEW + 1])
def test_a_tree_is_flushed_with_every_file_and_folder_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    (tmp_path / "cells").mkdir()
    files = [tmp_path / "cells" / str(number) for number in range(count)]
    for file in files:
        file.touch()
    calls = FileCalls().watch(monkeypatch)
    flush_tree(tmp_path)
    if any(call.name == "syncfs" for call in calls.made):
        assert count > durable_files.FEW
        assert calls.made[0] == ("syncfs", tmp_path)
    else:
        flushed = {call.path for call in calls.made if call.name == "fsync"}
        assert flushed == {*files, tmp_path, tmp_path / "cells"}


@pytest.mark.parametrize("name", ["drop", "stack_of_six", "wärme", "<script>", "..%2f.x", "a b"])
def test_a_printable_name_stays(name: str) -> None:
    assert path_name(name) == name


@pytest.mark.parametrize(
    ("name", "words"),
    [("a\x1b[31mb", "a_[31mb"), ("b\udcffc", "b_c"), ("\u202ed", "_d"), ("a\nb\x00", "a_b_")],
)
def test_what_a_terminal_would_obey_is_a_line(name: str, words: str) -> None:
    assert path_name(name) == words


def test_bytes_are_counted_and_characters_stay_whole() -> None:
    for most in (MOST_BYTES, 100):
        name = path_name("字" * 80, most)
        kept, _, digest = name.rpartition("-")
        assert kept == "字" * ((most - len(digest) - 1) // 3)
        assert len(name.encode()) <= most
        assert path_name("字" * 79, most) != name  # no two cut names are one
        assert path_name("字" * 80 + "_cost", most) != name
