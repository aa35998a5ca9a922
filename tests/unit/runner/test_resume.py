"""A run that was killed goes on where it was, and ends as one that was never interrupted.

Each of three configs is killed with one and two processes, once; every night 17 times, 102 in all.
`LAVENDER_TEST_KILLS` is another number;
`python -m tests.property.killed_runs` does as often as is asked for.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

import pytest

from lavendersim import open_run
from lavendersim.errors import TraceError, UsageError
from lavendersim.experiment import load_experiment
from lavendersim.runner import Progress, Run, finished_run, list_runs, run
from lavendersim.runner.run_lock import run_lock
from tests.forked_python import python
from tests.property.killed_runs import CONFIGS, prepared, wrong_when_resumed
from tests.runner.run_contents import contents
from tests.runner.small_configs import DROPS, write
from tests.thorough import THOROUGH

KILLS = int(os.environ.get("LAVENDER_TEST_KILLS", "17" if THOROUGH else "1"))


@pytest.mark.skipif(os.name != "posix", reason="kills as POSIX does")
@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize("name", CONFIGS)
def test_a_killed_run_that_is_resumed_is_one_that_never_was(
    tmp_path: Path, name: str, jobs: int
) -> None:
    case = prepared(tmp_path, name, CONFIGS[name])
    draw = random.Random(f"{name} {jobs}")
    for kill in range(KILLS):
        folder = tmp_path / f"{kill}"
        folder.mkdir()
        assert [
            *wrong_when_resumed(case, folder, jobs, draw.uniform(0.0, 1.2 * case.seconds))
        ] == []


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    return write(tmp_path)


class StopError(Exception):
    """What ends a run when all of its cells have ended, but before it is finished."""


def unfinished(config: Path, runs: Path) -> Run:
    """Return a run whose cells have all ended, and which did not finish."""

    def stop(*arguments: object) -> NoReturn:
        raise StopError

    with pytest.raises(StopError):
        run(config, runs, closing=stop)
    return list_runs(runs)[-1]


def resumed(config: Path, runs: Path) -> tuple[Run, list[str]]:
    """Resume a run; returns it and what was said about it, without where it is."""
    said: list[str] = []
    found = run(config, runs, progress=Progress(note=said.append), resume=True).run
    return found, [sentence.replace(str(runs), "RUNS") for sentence in said]


def test_cells_that_are_done_are_not_run_again(
    drops: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = contents(run(drops, tmp_path / "whole").run)
    left = unfinished(drops, tmp_path / "runs")
    (left.path / ".results.1-1.unfinished.json").write_text("{")
    monkeypatch.setattr("lavendersim.runner.executor.run_and_measure", None)
    found, said = resumed(drops, tmp_path / "runs")
    assert found.path == left.path
    assert said == [f"goes on with RUNS/{left.path.name}: 3 of 3 cells are done"]
    assert contents(found) == whole


def cut(log: Path) -> None:
    log.write_bytes(log.read_bytes()[:-10])


def flip(log: Path) -> None:
    data = bytearray(log.read_bytes())
    data[len(data) // 2] ^= 1
    log.write_bytes(data)


@pytest.mark.parametrize("harm", [cut, flip, Path.unlink])
def test_a_log_that_is_not_whole_is_made_again(
    drops: Path, tmp_path: Path, harm: Callable[[Path], None]
) -> None:
    whole = contents(run(drops, tmp_path / "whole").run)
    left = unfinished(drops, tmp_path / "runs")
    harm(left.cells[1].path)
    found, said = resumed(drops, tmp_path / "runs")
    assert said[1:] == ["1 run again: its log is cut, damaged or missing"]
    assert contents(found) == whole


def test_a_line_that_a_kill_has_cut_hides_none_behind_it(drops: Path, tmp_path: Path) -> None:
    whole = contents(run(drops, tmp_path / "whole").run)
    left = unfinished(drops, tmp_path / "runs")
    lines = (left.path / "ended.jsonl").read_text()
    (left.path / "ended.jsonl").write_text(lines[: lines.rindex('"measured"')])
    unfinished_again = tmp_path / "runs"
    found, said = resumed(drops, unfinished_again)
    assert said[1:] == ["1 measured now: the log was closed"]
    assert contents(found) == whole


@pytest.mark.parametrize("lost", [slice(0), slice(2)], ids=["every line", "all but two"])
def test_logs_of_which_no_line_is_left_are_not_run_again(
    drops: Path, tmp_path: Path, lost: slice, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = contents(run(drops, tmp_path / "whole").run)
    left = unfinished(drops, tmp_path / "runs")
    lines = (left.path / "ended.jsonl").read_text().splitlines(keepends=True)
    (left.path / "ended.jsonl").write_text("".join(lines[lost]))
    monkeypatch.setattr("lavendersim.runner.executor.run_and_measure", None)
    found, said = resumed(drops, tmp_path / "runs")
    assert said[0] == f"goes on with RUNS/{left.path.name}: 3 of 3 cells are done"
    assert said[1].endswith("measured now: the log was closed")
    assert contents(found) == whole


@pytest.mark.parametrize("harm", [cut, flip])
def test_a_log_that_is_not_whole_and_has_no_line_is_made_again(
    drops: Path, tmp_path: Path, harm: Callable[[Path], None]
) -> None:
    whole = contents(run(drops, tmp_path / "whole").run)
    left = unfinished(drops, tmp_path / "runs")
    (left.path / "ended.jsonl").unlink()
    harm(left.cells[1].path)
    found, said = resumed(drops, tmp_path / "runs")
    assert said[1:] == [
        "2 measured now: the log was closed",
        "1 run again: it was not noted how it ended",
    ]
    assert contents(found) == whole


# Worst states and their times, and a measure that is no number.
CHECKED = """\
always: {penetration: 1e-9, stop: false}
"""


@pytest.mark.parametrize("more", ["", CHECKED])
def test_logs_that_were_closed_and_not_measured_are_not_run_again(
    tmp_path: Path, more: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    drops = write(tmp_path, DROPS + more)
    whole = contents(run(drops, tmp_path / "whole").run)
    with monkeypatch.context() as patch:
        patch.setattr("lavendersim.runner.cell.note_measured", lambda log, ended: None)
        left = unfinished(drops, tmp_path / "runs")
    with monkeypatch.context() as patch:
        patch.setattr("lavendersim.runner.executor.run_and_measure", None)
        found, said = resumed(drops, tmp_path / "runs")
    assert found.path == left.path
    assert said[1:] == ["3 measured now: the log was closed"]
    assert contents(found) == whole


def test_a_line_of_an_older_version_does_as_none(drops: Path, tmp_path: Path) -> None:
    """It says that the log was closed, and not in how many steps: the log does."""
    whole = contents(run(drops, tmp_path / "whole").run)
    left = unfinished(drops, tmp_path / "runs")
    rows = [json.loads(line) for line in (left.path / "ended.jsonl").read_text().splitlines()]
    named = rows[0]["file"]
    for row in rows:
        if row["file"] == named:
            for key in ("outcome", "accuracy", "measured"):
                row.pop(key, None)
    (left.path / "ended.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    found, said = resumed(drops, tmp_path / "runs")
    assert said[1:] == ["1 measured now: the log was closed"]
    assert contents(found) == whole


def test_cells_that_failed_are_run_again(tmp_path: Path) -> None:
    drops = write(tmp_path, DROPS + "always: {penetration: 1e-9}\n")
    whole = contents(run(drops, tmp_path / "whole").run)
    unfinished(drops, tmp_path / "runs")
    found, said = resumed(drops, tmp_path / "runs")
    assert said[1:] == ["3 run again: failed: diverged, broke a bound or lost its process"]
    assert contents(found) == whole


def test_logs_of_other_versions_are_made_again(
    drops: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unfinished(drops, tmp_path / "runs")
    monkeypatch.setattr("lavendersim.runner.environment.versions", lambda: {"lavender": "9"})
    _, said = resumed(drops, tmp_path / "runs")
    assert said[1:] == ["3 run again: other versions are installed"]


def test_a_config_or_an_engine_that_has_changed_begins_a_new_run(
    drops: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    left = unfinished(drops, tmp_path / "runs")
    begins = f"has changed since RUNS/{left.path.name}: all 3 cells are run again"
    drops.write_text(DROPS + "# another\n")
    found, said = resumed(drops, tmp_path / "runs")
    assert (found.path != left.path, said) == (True, [f"the config {begins}"])
    drops.write_text(DROPS)
    left = unfinished(drops, tmp_path / "more")
    begins = begins.replace(begins.split()[3], f"RUNS/{left.path.name}:")
    hashes = "lavendersim.engine.sources.source_hash"
    monkeypatch.setattr(hashes, lambda: "another")
    found, said = resumed(drops, tmp_path / "more")
    assert (found.path != left.path, said) == (True, [f"the engine {begins}"])


def test_there_is_nothing_to_resume_of_what_is_finished(drops: Path, tmp_path: Path) -> None:
    runs, experiment = tmp_path / "runs", load_experiment(drops)
    assert finished_run(experiment, runs) is None
    first, said = resumed(drops, runs)
    assert said == ["nothing to resume, no run of it in RUNS: a new run begins"]
    found = finished_run(experiment, runs)
    assert found is not None
    assert found.path == first.path
    second, _ = resumed(drops, runs)
    assert second.path != first.path


def test_a_directory_that_another_process_runs_in_is_left_alone(
    drops: Path, tmp_path: Path
) -> None:
    left = unfinished(drops, tmp_path / "runs")
    before = {path: path.read_bytes() for path in left.path.rglob("*") if path.is_file()}
    with run_lock(left.path), pytest.raises(UsageError, match="another process runs its cells"):
        resumed(drops, tmp_path / "runs")
    assert before == {path: path.read_bytes() for path in left.path.rglob("*") if path.is_file()}


def test_a_damaged_note_of_what_ended_is_refused(drops: Path, tmp_path: Path) -> None:
    left = unfinished(drops, tmp_path / "runs")
    text = (left.path / "ended.jsonl").read_text()
    (left.path / "ended.jsonl").write_text(text.replace('"outcome"', '"outcame"'))
    with pytest.raises(TraceError, match=r"ended\.jsonl: damaged"):
        resumed(drops, tmp_path / "runs")


@pytest.mark.skipif(os.name != "posix", reason="limits of POSIX")
def test_after_a_full_disk_a_run_goes_on(drops: Path, tmp_path: Path) -> None:
    """A limit of the size of files stands for the disk: the system refuses to write as it does."""
    import resource

    whole = contents(run(drops, tmp_path / "whole").run)
    sizes = [log.stat().st_size for log in (tmp_path / "whole").glob("latest/cells/*")]
    limit = min(sizes) - 1

    def small() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    runs = tmp_path / "runs"
    command = [sys.executable, "-m", "lavender_cli.main", "run", drops, "--runs", runs]
    done = subprocess.run(command, preexec_fn=small, capture_output=True, text=True, check=False)
    assert done.returncode == 6
    assert f"go on with: lavender run {drops} --resume --runs {runs}" in done.stderr
    assert contents(resumed(drops, runs)[0]) == whole


def test_the_command_goes_on_and_says_so(drops: Path, tmp_path: Path) -> None:
    left = unfinished(drops, tmp_path / "runs")
    words = ("-m", "lavender_cli.main", "run", drops, "--resume", "--runs", tmp_path / "runs")
    for sentence in ("goes on with", "finished, nothing to resume: "):
        done = python(*words)
        assert done.returncode == 0, done.stderr
        assert f"drops: {sentence}" in done.stderr
    assert open_run(left.path).finished
    assert list_runs(tmp_path / "runs")[-1].path == left.path
