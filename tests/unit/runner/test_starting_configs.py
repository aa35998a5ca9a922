"""Configs to begin with: each asks a question, loads, and is written under a free name."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment
from lavendersim.runner.starting_configs import Start, start_named, starts, write_start


@pytest.mark.parametrize("start", starts(), ids=lambda start: start.name)
def test_each_is_a_config_with_its_question_and_its_own_name_in_it(
    start: Start, tmp_path: Path
) -> None:
    path = tmp_path / "mine.yaml"
    write_start(start, path)
    experiment = load_experiment(path)
    assert experiment.config.question == start.question.strip("\"'")
    assert "{name}" not in path.read_text()
    assert "mine.yaml" in path.read_text()


def test_a_name_of_none_is_reported_with_the_nearest() -> None:
    name = starts()[0].name
    assert start_named(name).name == name
    with pytest.raises(UsageError, match=f'did you mean "{name}"'):
        start_named(name + "x")


def test_nothing_is_written_over_and_no_other_suffix(tmp_path: Path) -> None:
    start, taken = starts()[0], tmp_path / "taken.yaml"
    taken.write_text("mine")
    with pytest.raises(UsageError, match="it is there already"):
        write_start(start, taken)
    with pytest.raises(UsageError, match=r"ends in \.yaml"):
        write_start(start, tmp_path / "a.txt")
    with pytest.raises(UsageError, match="no such folder"):
        write_start(start, tmp_path / "none" / "a.yaml")
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]
