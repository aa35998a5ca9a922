"""A config is read as far as one may be long; what is no file is refused by its name."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from lavendersim.errors import UsageError
from lavendersim.experiment.text import file as text_file
from lavendersim.experiment.text.file import read_file


def test_a_file_comes_with_its_size(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_bytes(b"duration: 1\n")
    assert read_file(path, "a.yaml") == (b"duration: 1\n", 12)


def test_of_a_file_that_is_too_long_the_beginning_and_its_size(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(text_file, "LARGEST_FILE", 4)
    path = tmp_path / "a.yaml"
    path.write_bytes(b"0123456789")
    assert read_file(path, "a.yaml") == (b"01234", 10)


def test_a_pipe_is_refused_before_it_is_waited_for(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(UsageError, match="the config: expected a file, this is a pipe"):
        read_file(pipe, "the config")


def test_a_file_that_is_not_there_and_a_folder(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"a\.yaml: no such file"):
        read_file(tmp_path / "a.yaml", "a.yaml")
    with pytest.raises(UsageError, match="is a directory"):
        read_file(tmp_path, "a.yaml")
