"""A table of a run that is not as it was written is refused, and hides no other run."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

import pytest
from damaged_runs import DRAWN, copied, made, verb

from lavendersim import open_run
from lavendersim.errors import TraceError
from tests.older_runs import without_digests

TABLES = {"cells.json", "results.json", "results.csv", "config.yaml", "resolved.json", "env.json"}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of two cells, with its figure."""
    return made(DRAWN, tmp_path_factory.mktemp("whole"))


def with_another_digit(table: Path) -> None:
    """Change the last digit of the first number with several."""
    text = table.read_text()
    number = re.search(r"\d\.\d{3,}", text)
    assert number is not None
    last = number.end() - 1
    table.write_text(text[:last] + str((int(text[last]) + 1) % 10) + text[last + 1 :])


def test_done_has_the_digest_of_every_table(whole: Path) -> None:
    lines = [line.split("  ") for line in (whole / "DONE").read_text().splitlines()]
    assert {name for _, name in lines} == TABLES
    for digest, name in lines:
        assert hashlib.sha256((whole / name).read_bytes()).hexdigest() == digest


def test_a_digit_of_the_results_that_was_changed_is_not_shown(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    with_another_digit(run / "results.json")
    for arguments in (("show", run), ("show", run, "--json")):
        done = verb(*arguments)
        assert (done.code, done.stdout) == (3, "")
        assert done.stderr.startswith(f"{run / 'results.json'}: changed since the run wrote it")
    with pytest.raises(TraceError, match="changed since"):
        open_run(run).results()


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("results.json", "{"),
        ("results.json", "[]"),
        ("results.json", "[" * 100_000),
        ("results.json", '{"cells": [], "passed": true}'),
        ("results.json", '{"cells": [1], "passed": true}'),
        ("results.json", None),
        ("cells.json", "\x00"),
        ("cells.json", '{"cells": [{}]}'),
        ("DONE", "abc"),
    ],
)
@pytest.mark.parametrize("older", [False, True])
def test_one_damaged_table_is_said_and_the_other_runs_are_listed(
    whole: Path, tmp_path: Path, name: str, text: str | None, older: bool
) -> None:
    good = copied(whole, tmp_path / "runs")
    bad = copied(whole, tmp_path)
    bad = bad.rename(tmp_path / "runs" / f"0-{bad.name}")  # before the other one
    if older:
        without_digests(bad)
    if text is None:
        (bad / name).unlink()
    else:
        (bad / name).write_text(text)
    done = verb("ls", "--runs", tmp_path / "runs")
    assert done.code == 3
    first, second = done.stdout.splitlines()
    assert first.startswith(f"BAD   {bad}  ")
    assert f"  {good}  " in second
    assert not second.startswith(("BAD", "CUT"))
    assert done.stderr.startswith(f"{bad / name}: ")
    assert len(done.stderr.splitlines()) == 1
    rows = json.loads(verb("ls", "--runs", tmp_path / "runs", "--json").stdout)
    assert [bool(row["damaged"]) for row in rows] == [True, False]


def test_a_seal_that_has_lost_its_digests_is_none_of_an_older_run(
    whole: Path, tmp_path: Path
) -> None:
    run = copied(whole, tmp_path)
    (run / "DONE").write_text("")
    done = verb("show", run)
    assert done.code == 3
    assert done.stderr.startswith(f"{run / 'DONE'}: damaged")


def test_a_config_that_was_changed_in_a_run_is_refused(whole: Path, tmp_path: Path) -> None:
    run = copied(whole, tmp_path)
    text = (run / "config.yaml").read_text()
    (run / "config.yaml").write_text(text.replace("the ball", "The ball") + "\n")
    assert verb("plot", run).code == 3
