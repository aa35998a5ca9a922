"""What a shell completes: verbs, options, runs, measures and starting configs; never an error."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import lavender

from lavendersim.experiment import load_experiment
from lavendersim.runner import run
from tests.drop_config import DROP


def completed(line: str, where: Path) -> list[str]:
    """Return what bash is offered behind the last word of a line."""
    words = line.split(" ")
    done = lavender(
        where=where,
        _LAVENDER_COMPLETE="complete_bash",
        COMP_WORDS=line,
        COMP_CWORD=str(len(words) - 1),
    )
    assert done.stderr == ""
    return done.stdout.split()


@pytest.fixture(scope="module")
def where(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("completed")
    (folder / "drop.yaml").write_text(DROP)
    for root in ("runs", "others"):
        run(load_experiment(folder / "drop.yaml"), folder / root)
    return folder


def test_verbs_options_measures_and_starting_configs(where: Path) -> None:
    assert {"recover", "replay", "rm", "run"} == set(completed("lavender r", where))
    assert "--refine" in completed("lavender run --ref", where)
    assert completed("lavender measures first_", where) == ["first_apex", "first_passage"]
    assert completed("lavender new sl", where) == ["slide", "slope"]


@pytest.mark.parametrize("verb", ["show", "plot", "replay", "verify", "judge", "rm", "open"])
def test_runs_are_those_of_the_folder_that_is_meant(verb: str, where: Path) -> None:
    (mine,), (other,) = ([*(where / root).glob("2*")] for root in ("runs", "others"))
    assert completed(f"lavender {verb} 2", where) == [mine.name]
    assert completed(f"lavender {verb} --runs others 2", where) == [other.name]
    assert completed(f"lavender {verb} runs/2", where) == [f"runs/{mine.name}"]


def test_where_nothing_can_be_read_nothing_is_offered_and_nothing_said(tmp_path: Path) -> None:
    assert completed("lavender show 2", tmp_path) == []
    damaged = tmp_path / "runs" / "20260101T000000Z-drop-00000000"
    damaged.mkdir(parents=True)
    (damaged / "cells.json").write_text("{")
    assert completed("lavender show 2", tmp_path) == [damaged.name]


def test_a_shell_is_given_its_script(tmp_path: Path) -> None:
    for shell in ("bash", "zsh", "fish"):
        done = lavender(where=tmp_path, _LAVENDER_COMPLETE=f"source_{shell}")
        assert done.returncode == 0
        assert "_LAVENDER_COMPLETE" in done.stdout
