"""Configs among files and folders: which they are, and all defects of all of them at once."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.errors import ConfigError, UsageError
from lavendersim.runner.configs import find_configs, load_all
from tests.drop_config import DROP


def test_a_folder_stands_for_its_configs_in_order_without_those_to_extend(tmp_path: Path) -> None:
    for name in ("b.yaml", "a.yml", "_base.yaml", "notes.txt", "deep/c.yaml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    found = [str(path.relative_to(tmp_path)) for path in find_configs([tmp_path])]
    assert found == ["a.yml", "b.yaml", "deep/c.yaml"]


def test_copies_in_directories_of_runs_are_none(tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    (run / "config.yaml").write_text("")
    (run / "cells.json").write_text("{}")
    (tmp_path / "a.yaml").write_text("")
    assert find_configs([tmp_path]) == [tmp_path / "a.yaml"]


def test_what_is_named_twice_is_found_once(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("")
    assert find_configs([path, tmp_path, path]) == [path]
    base = tmp_path / "_base.yaml"
    base.write_text("")
    assert find_configs([base]) == [base]  # who names it means it


def test_an_empty_folder_and_a_name_of_nothing_are_reported(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"no \*\.yaml file in this folder"):
        find_configs([tmp_path])
    with pytest.raises(UsageError, match="no such file or folder"):
        find_configs([tmp_path / "none.yaml"])


def test_defects_of_all_files_are_reported_at_once(tmp_path: Path) -> None:
    (tmp_path / "good.yaml").write_text(DROP)
    (tmp_path / "bad.yaml").write_text(DROP.replace("duration: 0.5", "duration: long"))
    (tmp_path / "worse.yaml").write_text(DROP.replace("mass: 1.0", "mass: -1"))
    with pytest.raises(ConfigError) as error:
        load_all([tmp_path])
    assert [Path(one.file).name for one in error.value.defects] == ["bad.yaml", "worse.yaml"]
    (one,) = load_all([tmp_path / "good.yaml"])
    assert one.name == "good"
