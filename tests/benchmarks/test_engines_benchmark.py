"""The published tables of engines: what is kept of a run, and what the tables say of it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.benchmarks import engines
from tests.made_costs import cost_table, row_data

TEN = {"iterations": 10}


def test_nothing_that_is_kept_says_where_somebody_ran_it() -> None:
    said = {"rows": [{"error": 1, "log": "/home/a/b.mcap"}], "machine": {"kernel cache": "/home"}}
    assert engines.without_places(said) == {"rows": [{"error": 1}], "machine": {}}


def test_a_log_has_its_digest_under_its_experiment(tmp_path: Path) -> None:
    """SHA-256 of no bytes, by FIPS 180-4."""
    cells = tmp_path / "20261126T055000Z-rest-engine=all-1d4c6cdb" / "cells"
    cells.mkdir(parents=True)
    (cells / "ab.mcap").write_bytes(b"")
    (tmp_path / "latest").symlink_to(cells.parent)
    empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    assert engines.digests(tmp_path) == {"rest-engine=all-1d4c6cdb": {"ab": empty}}


def test_logs_made_again_are_compared_with_the_digests_that_are_kept() -> None:
    kept = {"rest-1": {"a": "11", "b": "22"}, "stack-2": {"c": "33"}}
    assert engines.unequal_logs(kept, {"rest-1": {"a": "11", "b": "22"}}) == []
    (one,) = engines.unequal_logs(kept, {"rest-1": {"a": "11", "b": "20"}})
    assert one == "rest-1: 1 of 2 logs differ: b"
    assert engines.unequal_logs(kept, {"new-3": {"d": "44"}})  # of which nothing is kept
    assert engines.unequal_logs(kept, {}) == ["no log was made"]


def test_some_cases_alone_may_be_made_again() -> None:
    words = engines.COMMANDS["check"]
    left = [word for word in words if engines.is_asked(word, ["rest"])]
    assert [word for word in left if word.endswith(".yaml")] == ["configs/scenes/rest.yaml"]
    assert left[-4:] == ["--engine", "all", "--yes", "--json"]


def test_logs_are_made_again_by_the_sources_of_the_commit_that_they_are_of(tmp_path: Path) -> None:
    """Of another commit configs have other keys, and every log other bytes."""
    head = engines._git("rev-parse", "HEAD")
    if not head:
        pytest.skip("no git, or no clone")
    engines.put_sources(head, tmp_path / "sources")
    ask = "import lavendersim, lavender_cli.main as cli; print(lavendersim.__file__, cli.__file__)"
    found = subprocess.run(
        [sys.executable, "-c", ask],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path / "sources")},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    assert all(one.startswith(str(tmp_path / "sources")) for one in found)
    with pytest.raises(SystemExit, match="is not in this clone"):
        engines.put_sources("0" * 40, tmp_path / "none")


def test_an_engine_that_misses_the_target_says_how_near_it_came() -> None:
    target = {"target": 0.001, "sentence": "", "fragment": None}
    table = cost_table(
        row_data(role="specified", error=1e-4, contacts=24.0, iterations=2.0),
        row_data(
            engine="physx", settings=TEN, solver="", error=0.02, least_error=0.01, contacts=24.0
        ),
        targets=[
            target | {"reached": True, "row": 0, "engine": "lavender"},
            target | {"reached": False, "row": None, "engine": "physx"},
        ],
    )
    ours, theirs = engines.cost_lines(table)[2:]
    assert ours.startswith("| lavender | 0.01 % | 2 ms | 24, 2 | adaptive, 240 Hz, 8 sweeps, warm")
    assert theirs == "| PhysX | 1 % to 2 % | 2 ms | 24, not reported | none; at best 2 % |  |"


def test_a_square_has_its_number_and_its_range_over_starts() -> None:
    one = {"case": "scenes/rest", "solver": "mujoco", "verdict": "fails", "number": 0.25}
    made = {"cases": ["scenes/rest"], "solvers": {"mujoco": 0}}
    lines = engines.check_lines({**made, "entries": [{**one, "least": 0.125, "most": 0.25}]})
    assert lines[-1] == "| rest | fails 0.25 (0.12 to 0.25) |"
    refused = {**one, "verdict": "refused", "number": None, "least": None, "most": None}
    assert engines.check_lines({**made, "entries": [refused]})[-1] == "| rest | refused |"


@pytest.mark.skipif(not (engines.KEPT / "logs.json").exists(), reason="no samples are kept")
def test_the_tables_of_the_pages_are_those_of_the_samples_that_are_kept() -> None:
    text = engines.tables()
    for page in engines.PAGES:
        lines = [line for line in text.splitlines() if line.startswith("|")]
        own = lines if page.name != "README.md" else engines.cost_only(text)
        assert "\n".join(own[:3]) in page.read_text(), page
    made = json.loads((engines.KEPT / "logs.json").read_text())
    assert not made["changed"]
    assert all(len(one) == 64 for run in made["sha256"].values() for one in run.values())


def test_a_page_gets_its_tables_between_its_marks() -> None:
    page = "a\n<!-- engines -->\nold\n<!-- end -->\nb\n<!-- end -->\n"
    made = engines.with_part(page, "| new |")
    assert made == "a\n<!-- engines -->\n\n| new |\n\n<!-- end -->\nb\n<!-- end -->\n"
