"""`show` of runs of this version and of older ones, of which less was recorded."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from damaged_runs import DRAWN, copied, made, verb

from lavendersim.runner import list_runs
from tests.older_runs import without_residuals


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of two cells."""
    return made(DRAWN, tmp_path_factory.mktemp("whole"))


def test_a_run_shows_what_its_kernels_took_and_how_well_steps_were_solved(whole: Path) -> None:
    done = verb("show", whole)
    assert (done.code, done.stderr) == (0, "")
    seconds = json.loads((whole / "results.json").read_text())["compile_s"]
    assert f", compile {seconds:.1f} s\n" in done.stdout
    assert done.stdout.count("  residual <= ") == 2
    assert "not recorded" not in done.stdout


def test_what_the_first_versions_did_not_record_is_said_to_be_so(
    whole: Path, tmp_path: Path
) -> None:
    run = without_residuals(copied(whole, tmp_path))
    done = verb("show", run)
    assert (done.code, done.stderr) == (0, "")
    assert ", compile not recorded\n" in done.stdout
    assert done.stdout.count("  residual not recorded  ") == 2
    assert "nan" not in done.stdout
    assert verb("show", run, "--cell", "1").code == 0
    (row, _) = json.loads(verb("show", run, "--json").stdout)["cells"]
    assert (row["worst_residual"], row["not_converged_steps"]) == ("nan", None)


def test_runs_of_the_first_versions_are_listed_compared_and_exported(
    whole: Path, tmp_path: Path
) -> None:
    run = without_residuals(copied(whole, tmp_path / "runs"))
    assert [one.path for one in list_runs(tmp_path / "runs")] == [run]
    listed = verb("ls", "--runs", tmp_path / "runs")
    assert (listed.code, listed.stderr) == (0, "")
    assert "damaged" not in listed.stdout
    for words in (("diff", run, whole), ("export", run)):
        done = verb(*words)
        assert (done.code, done.stderr) == (0, ""), (words, done)
