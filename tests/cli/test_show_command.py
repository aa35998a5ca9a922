"""`show` of runs of this version and of older ones, of which less was recorded."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from damaged_runs import DRAWN, copied, made, verb

from lavendersim.runner import list_runs
from lavendersim.trace import source
from tests.older_runs import of_other_keys, without_residuals


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


def test_of_a_config_that_is_not_understood_all_else_is_read(whole: Path, tmp_path: Path) -> None:
    """Its keys are those of another version; logs, results and the index are what they were."""
    run = of_other_keys(copied(whole, tmp_path))
    why = f'{run / "config.yaml"}:1:1: unknown key "former" in the experiment: '
    why += "this version does not understand the run's config"

    shown, before = verb("show", run), verb("show", whole)
    assert (shown.code, shown.stderr) == (0, why + "\n")
    assert shown.stdout.splitlines()[1:] == before.stdout.splitlines()[1:]  # but for the path
    assert verb("show", run, "--cell", "1").code == 0

    compared = verb("diff", run, whole)
    assert (compared.code, compared.stderr) == (1, "")
    assert why in compared.stdout
    assert "former  3 -> (absent)" in compared.stdout
    assert "cells  2 pairs by e" in compared.stdout
    assert compared.stdout.count("equal to the bit, 961 states") == 2

    exported = verb("export", run, "--to", "csv", "-o", tmp_path / "old")
    assert (exported.code, exported.stderr) == (0, why + "\n")
    assert verb("export", whole, "--to", "csv", "-o", tmp_path / "new").code == 0
    for table in ("cells", "verdicts", "step", "contact"):
        old, new = (tmp_path / side / f"{table}.csv" for side in ("old", "new"))
        assert old.read_bytes() == new.read_bytes(), table

    for words in (("judge", run), ("plot", run)):  # what to measure stands in the config alone
        done = verb(*words)
        assert (done.code, done.stderr) == (3, why + "\n"), words
    assert f"{why}; its measures and verdicts are not compared" in verb("verify", run).stdout


def test_logs_of_configs_that_are_not_understood_are_compared(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(data: object) -> None:
        raise source._OtherVersion("1 validation error\nscene.former\n  Field required")

    run = of_other_keys(copied(whole, tmp_path))
    monkeypatch.setattr(source, "_config_of", refused)
    compared = verb("diff", run, whole)
    assert (compared.code, compared.stderr) == (1, "")
    assert compared.stdout.count("equal to the bit, 961 states") == 2
