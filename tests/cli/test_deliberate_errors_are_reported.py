"""A deliberate error is reported wherever a run is shown, and nowhere else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import lavender

from lavendersim.runner import open_run
from tests.drop_config import LOW

DROP = f"{LOW}duration: 0.05\n"
MISTAKEN = DROP + "sweep: {m: {path: study.mistake, values: [none, capture_in_sweeps]}}\n"
SAID = "study-only: capture_in_sweeps, a deliberate error"


@pytest.fixture(scope="module")
def mistaken(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a config of which one cell of two makes a mistake; it has been run."""
    folder = tmp_path_factory.mktemp("mistaken")
    (folder / "drop.yaml").write_text(MISTAKEN)
    done = lavender("run", "drop.yaml", "--json", where=folder)
    assert done.returncode == 0
    json.loads(done.stdout)  # what is written for people stays out of it
    assert f"drop: {SAID} in 1 of 2 cells\n" in done.stderr
    return folder


def test_check_says_it(mistaken: Path) -> None:
    assert SAID in lavender("check", "drop.yaml", where=mistaken).stderr


def test_plan_says_it_of_the_cells_that_make_it(mistaken: Path) -> None:
    lines = lavender("plan", "drop.yaml", where=mistaken).stdout.splitlines()
    wrong = lines.index("drop: mistake: capture_in_sweeps (m=capture_in_sweeps)")
    assert [k for k, line in enumerate(lines) if line.startswith(SAID)] == [wrong + 1]


def test_the_log_and_show_say_it_of_the_cells_that_make_it(mistaken: Path) -> None:
    right, wrong = (cell.trace().metadata for cell in open_run(None, mistaken / "runs").cells)
    assert "study-only" not in right
    assert wrong["study-only"]["capture_in_sweeps"].startswith("a deliberate error: ")
    assert not right["plan"]["capture_in_sweeps"].startswith("on")
    lines = lavender("show", where=mistaken).stdout.splitlines()
    plan = lines.index("plan of m=capture_in_sweeps")
    assert [k for k, line in enumerate(lines) if SAID in line] == [plan + 1]


def test_nothing_is_said_where_none_is_made(tmp_path: Path) -> None:
    (tmp_path / "drop.yaml").write_text(DROP)
    for verb in ("run", "plan", "show"):
        done = lavender(verb, *(["drop.yaml"] if verb != "show" else []), where=tmp_path)
        assert done.returncode == 0
        assert "study-only" not in done.stdout + done.stderr
