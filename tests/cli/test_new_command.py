"""`lavender new`: a list of questions, a commented config for each, which says what is true."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from command_line import lavender

from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment
from lavendersim.runner import load_all, run
from lavendersim.runner.starting_configs import start_named, starts, write_start

STARTS = starts()
NAMES = [start.name for start in STARTS]


def test_without_a_name_the_questions_are_listed_and_nothing_is_written(tmp_path: Path) -> None:
    done = lavender("new", where=tmp_path)
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert [line.split()[1] for line in lines] == NAMES
    assert all(line.endswith(start.question) for line, start in zip(lines, STARTS, strict=True))
    assert "lavender new NAME [FILE]" in done.stderr
    assert [*tmp_path.iterdir()] == []


def test_a_config_is_written_once_and_never_over_a_file(tmp_path: Path) -> None:
    done = lavender("new", "bounce", where=tmp_path)
    assert done.returncode == 0, done.stderr
    written = (tmp_path / "bounce.yaml").read_text()
    assert written.startswith("# Run it: lavender run bounce.yaml --plot\n")
    assert "lavender run bounce.yaml --plot" in done.stdout
    again = lavender("new", "bounce", where=tmp_path)
    assert (again.returncode, again.stdout) == (2, "")
    assert "bounce.yaml: it is there already" in again.stderr
    assert (tmp_path / "bounce.yaml").read_text() == written
    assert lavender("new", "bounce", "mine.yaml", where=tmp_path).returncode == 0
    assert "lavender run mine.yaml --plot" in (tmp_path / "mine.yaml").read_text()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("bonce",), 'no starting config is called "bonce"; did you mean "bounce"?'),
        (("xyzzy",), f'no starting config is called "xyzzy"; valid here: {", ".join(NAMES)}'),
        (("bounce", "mine.txt"), "mine.txt: the name of a config ends in .yaml"),
        (("bounce", "none/mine.yaml"), "none: no such folder"),
    ],
)
def test_what_cannot_be_written_is_refused(
    words: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    done = lavender("new", *words, where=tmp_path)
    assert (done.returncode, done.stderr.strip()) == (2, said)
    assert [*tmp_path.iterdir()] == []


def test_a_link_to_nowhere_is_not_written_through(tmp_path: Path) -> None:
    (tmp_path / "bounce.yaml").symlink_to(tmp_path / "elsewhere.yaml")
    with pytest.raises(UsageError, match="there already"):
        write_start(start_named("bounce"), tmp_path / "bounce.yaml")
    assert not (tmp_path / "elsewhere.yaml").exists()


@pytest.mark.parametrize("name", NAMES)
def test_a_config_meets_its_claims_is_drawn_and_nothing_of_it_is_suspicious(
    name: str, tmp_path: Path
) -> None:
    path = tmp_path / f"{name}.yaml"
    write_start(start_named(name), path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (experiment,) = load_all([path], strict=True)
    config = load_experiment(path).config
    assert config.question
    assert config.expected
    assert experiment.is_drawn
    assert experiment.always is not None
    assert path.read_text().count("#") >= 6  # it explains itself
    finished = run(experiment, tmp_path / "runs", 1)
    assert [one.message for one in finished.verdicts if not one.passed] == []
    assert finished.good
    assert any(not one.name.startswith("always: ") for one in finished.verdicts)
