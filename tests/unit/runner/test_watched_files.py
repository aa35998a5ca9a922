"""What is watched of a config, and that each save of it is seen once."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from lavendersim.runner import watched_files
from lavendersim.runner.watched_files import saves, stamps_of


def write(file: Path, text: str = "duration: 1\n") -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def test_a_config_is_watched_with_what_it_extends_and_its_measures(tmp_path: Path) -> None:
    config = write(tmp_path / "a" / "drop.yaml", 'extends: "../base.yaml"  # the rest\n')
    base = write(tmp_path / "base.yaml", "extends: more/above.yaml\n")
    above = write(tmp_path / "more" / "above.yaml", "extends: ../base.yaml\n")  # refused elsewhere
    own = write(tmp_path / "a" / "measures.py", "")
    write(tmp_path / "a" / "other.yaml")
    assert {file.resolve() for file in stamps_of([config])} == {config, base, above, own}


def test_a_folder_is_watched_with_all_its_configs(tmp_path: Path) -> None:
    one, two = write(tmp_path / "one.yaml"), write(tmp_path / "in" / "two.yaml")
    assert set(stamps_of([tmp_path])) == {one, two}


def test_every_save_is_seen_once_and_a_file_that_is_away_for_a_moment_is_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = write(tmp_path / "drop.yaml")
    looks: list[str] = []

    def editor(seconds: float) -> None:
        """What happens between two looks: an editor that moves a new file into the place."""
        looks.append("")
        if len(looks) == 2:
            config.rename(tmp_path / "old.txt")
        if len(looks) == 4:
            write(config, "duration: 2.0\n")
        assert len(looks) < 10

    monkeypatch.setattr(watched_files.time, "sleep", editor)
    watching = saves([config])
    assert next(watching) == 1
    assert looks == []
    assert next(watching) == 1
    assert len(looks) == 4


def test_a_save_during_a_run_is_seen_after_it(tmp_path: Path) -> None:
    config = write(tmp_path / "drop.yaml")
    watching = saves([config])
    next(watching)
    os.utime(config, ns=(1, 1))
    assert next(watching) == 1
