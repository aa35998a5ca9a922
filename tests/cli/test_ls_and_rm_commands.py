"""Runs listed and removed: which are meant, which stay, and what `latest` then names."""

from __future__ import annotations

import json
import os
import re
import shutil
from pathlib import Path

import pytest
import typer
from command_line import lavender
from typer.testing import CliRunner, Result

from lavender_cli.ls import with_question
from lavender_cli.main import app
from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment
from lavendersim.runner import list_runs, open_run, run
from lavendersim.runner.run_lock import run_lock
from tests.drop_config import DROP

# By age; the first of `drop` met another claim.
NAMES = (
    "20260101T000000Z-drop-00000000",
    "20260201T000000Z-drop-00000000",
    "20260301T000000Z-other-00000000",
    "20260401T000000Z-drop-00000000",
)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four runs of two experiments, three of them with a tag; one did not finish."""
    folder = tmp_path_factory.mktemp("made")
    config = folder / "drop.yaml"
    config.write_text(DROP)
    (folder / "other.yaml").write_text(DROP)
    for name in NAMES:
        experiment = load_experiment(folder / f"{name.split('-')[1]}.yaml")
        tags = ["kept", "v2"] if "03" in name[:8] else ["try"] if "drop" in name else []
        found = run(experiment, folder / "new", tags=tags).run.path
        (folder / "runs").mkdir(exist_ok=True)
        found.rename(folder / "runs" / name)
    (folder / "runs" / NAMES[0] / "DONE").unlink()
    (folder / "runs" / "latest").symlink_to(NAMES[3])
    return folder / "runs"


@pytest.fixture
def runs(made: Path, tmp_path: Path) -> Path:
    shutil.copytree(made, tmp_path / "runs", symlinks=True)
    return tmp_path / "runs"


def verb(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def names_listed(runs: Path, *options: object) -> list[str]:
    rows = json.loads(verb("ls", "--runs", runs, "--json", *options).stdout)
    return [Path(row["path"]).name for row in rows]


def test_a_line_says_how_a_run_ended_when_it_began_its_cells_and_its_size(runs: Path) -> None:
    lines = verb("ls", "--runs", runs).stdout.splitlines()
    size = sum(log.stat().st_size for log in (runs / NAMES[2]).glob("cells/*"))
    found = re.fullmatch(
        rf"pass  {runs / NAMES[2]}  2026-03-01 00:00 +1 cell +([\d.]+) kB  \[kept v2\]  How high\?",
        lines[2],
    )
    assert found, lines[2]
    assert float(found[1]) * 1e3 == pytest.approx(size, rel=0.005)  # three digits
    assert [line[:4] for line in lines] == ["----", "pass", "pass", "pass"]


def test_a_run_of_a_version_that_kept_no_question_is_listed_without(runs: Path) -> None:
    index = runs / NAMES[0] / "cells.json"  # of a run that did not finish, so that it has no seal
    table = json.loads(index.read_text())
    del table["question"]
    index.write_text(json.dumps(table))
    lines = verb("ls", "--runs", runs).stdout.splitlines()
    assert ["How high?" in line for line in lines] == [False, True, True, True]


def test_a_question_that_a_terminal_has_no_room_for_stands_below_and_is_marked_as_cut() -> None:
    line, question = typer.style("pass", fg="green") + "  runs/a", "How high\n  does it bounce?"
    whole = "How high does it bounce?"
    assert with_question(line, question, None) == f"{line}  {whole}"
    room = len("pass  runs/a") + 2 + len(whole)
    assert with_question(line, question, room) == f"{line}  {whole}"
    assert with_question(line, question, room - 1) == f"{line}\n      {whole}"
    assert with_question(line, question, 20) == f"{line}\n      How high does…"
    assert with_question(line, "", 20) == line


@pytest.mark.parametrize(
    ("options", "which"),
    [
        ((), (0, 1, 2, 3)),
        (("--name", "drop"), (0, 1, 3)),
        (("--name", "o*", "--name", "nothing"), (2,)),
        (("--verdict", "unfinished"), (0,)),
        (("--verdict", "pass", "--name", "drop"), (1, 3)),
        (("--verdict", "fail"), ()),
        (("--tag", "v2"), (2,)),
        (("--older", "2026-02-01"), (0, 1)),
        (("--newer", "2026-02-01"), (1, 2, 3)),
        (("--newer", "2026-01-15", "--older", "2026-03-15"), (1, 2)),
        (("--older", "0s"), (0, 1, 2, 3)),
        (("--older", "200000d"), ()),
    ],
)
def test_options_say_which_runs(runs: Path, options: tuple[str, ...], which: tuple[int]) -> None:
    assert names_listed(runs, *options) == [NAMES[number] for number in which]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ls", "--older", "yesterday"), "expected a span such as 12h, 30d or 2w, or a date"),
        (("ls", "--verdict", "good"), "expected pass, fail, unclaimed, unfinished or damaged"),
        (("rm", "--larger", "1 stone"), "expected a size such as 200MB or 1.5GB"),
        (("rm",), "expected either runs by name, or options"),
        (("rm", NAMES[0], "--name", "drop"), "expected either runs by name, or options"),
        (("rm", "--tag", "try"), "there is nobody to ask: --yes removes them"),
    ],
)
def test_what_cannot_be_meant_is_refused(runs: Path, words: tuple[str, ...], said: str) -> None:
    done = lavender(*words, "--runs", runs, where=runs.parent)
    assert (done.returncode, said in done.stderr) == (2, True), done.stderr
    assert len(names_listed(runs)) == len(NAMES)


def test_by_options_the_newest_finished_run_of_each_experiment_stays(runs: Path) -> None:
    assert "would remove 2 runs" in verb("rm", "--runs", runs, "--older", "0s", "-n").stdout
    assert len(names_listed(runs)) == len(NAMES)
    done = verb("rm", "--runs", runs, "--older", "0s", "--yes")
    assert done.exit_code == 0
    assert names_listed(runs) == [NAMES[2], NAMES[3]]
    assert verb("rm", "--runs", runs, "--older", "0s", "--yes").exit_code == 0
    assert names_listed(runs) == [NAMES[2], NAMES[3]]


def test_larger_runs_are_found_by_their_logs(runs: Path) -> None:
    assert "would remove 2 runs" in verb("rm", "--runs", runs, "--larger", "1B", "-n").stdout
    assert verb("rm", "--runs", runs, "--larger", "1GB", "-n").stdout == ""


def test_a_run_that_is_named_goes_and_latest_names_another(runs: Path) -> None:
    assert verb("rm", "--runs", runs, "latest", NAMES[3], "--yes").exit_code == 0
    assert names_listed(runs) == [*NAMES[:3]]
    assert open_run(None, runs).path.name == NAMES[2]
    assert os.readlink(runs / "latest") == NAMES[2]
    assert verb("rm", "--runs", runs, *NAMES[:3], "--yes").exit_code == 0
    assert list(runs.iterdir()) == []


def test_a_directory_that_is_no_run_is_never_removed(runs: Path) -> None:
    other = runs / "notes"
    other.mkdir()
    (other / "text").write_text("mine")
    assert verb("rm", "--runs", runs, other, "--yes").exit_code != 0
    assert (other / "text").read_text() == "mine"


def test_a_run_that_goes_on_stays(runs: Path) -> None:
    with run_lock(runs / NAMES[0]):
        done = lavender("rm", NAMES[0], "--runs", runs, "--yes", where=runs.parent)
    assert done.returncode == 2
    assert "another process runs its cells" in done.stderr
    assert len(list_runs(runs)) == len(NAMES)


def test_what_a_killed_removal_leaves_is_no_run_and_goes_with_the_next(runs: Path) -> None:
    (runs / NAMES[1]).rename(runs / f".removed-1-{NAMES[1]}")
    assert names_listed(runs) == [NAMES[0], NAMES[2], NAMES[3]]
    assert verb("rm", "--runs", runs, NAMES[0], "--yes").exit_code == 0
    assert {path.name for path in runs.iterdir()} == {NAMES[2], NAMES[3], "latest"}


def test_a_tag_that_is_no_word_is_refused(tmp_path: Path) -> None:
    config = tmp_path / "drop.yaml"
    config.write_text(DROP)
    for tag in ("", "two words", "a/b", "\x1b[31m"):
        with pytest.raises(UsageError, match="expected a word of letters"):
            run(config, tmp_path / "runs", tags=[tag])
    assert not (tmp_path / "runs").exists()


def test_a_cell_is_shown_with_its_log_and_what_replays_it(runs: Path) -> None:
    said = verb("show", "--runs", runs, NAMES[2], "--cell", "0").stdout
    (log,) = (runs / NAMES[2]).glob("cells/*.mcap")
    assert f"log     {log}\n" in said
    assert f"replay  lavender replay {runs / NAMES[2]} --cell 0\n" in said
    measures = json.loads((runs / NAMES[2] / "results.json").read_text())["cells"][0]["measures"]
    assert all(f"  {name}  " in said for name in measures)
    row = json.loads(verb("show", "--runs", runs, NAMES[2], "--cell", "0", "--json").stdout)
    assert row["log"] == str(log)
    done = lavender("show", NAMES[2], "--runs", runs, "--cell", "1", where=runs.parent)
    assert done.returncode == 2
