"""Shards merge into the run that one process makes; what is missing, damaged or differs is said."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from shards_made import merged, shard

from lavendersim.errors import TraceError
from lavendersim.runner import run
from lavendersim.runner.merge import Missing, merge
from tests.runner.run_contents import contents
from tests.runner.small_configs import DROPS, write

# Two products of which one simulation is the same: it has one log.
PRODUCTS = DROPS.split("expect:")[0].replace(
    "  e: {path: scene.bodies.ball.surface.restitution, values: [0.2, 0.5, 0.8]}\n",
    "  - e: {path: scene.bodies.ball.surface.restitution, values: [0.2, 0.8]}\n"
    "  - f: {path: scene.bodies.ball.surface.restitution, values: [0.8, 0.9]}\n",
)


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    return write(tmp_path)


def a_log(into: Path) -> Path:
    return sorted(into.glob("shards/*/cells/*.mcap"))[0]


@pytest.mark.parametrize("text", [DROPS, PRODUCTS], ids=["one product", "a cell in two products"])
def test_three_shards_merge_into_what_one_process_runs(tmp_path: Path, text: str) -> None:
    drops, into = write(tmp_path, text), tmp_path / "shared"
    for part in (3, 1, 2):
        done = shard(drops, into, (part, 3))
        assert done.ran == done.ended == done.cells == 1
    assert contents(merged(into)) == contents(run(drops, tmp_path / "whole").run)


def test_a_merge_names_the_cells_that_are_missing(drops: Path, tmp_path: Path) -> None:
    into = tmp_path / "shared"
    shard(drops, into, (2, 3))
    assert merge(into, tmp_path / "runs") == Missing(["e=0.2", "e=0.8"], 0, [], 3)
    assert not (tmp_path / "runs").exists()


def test_a_log_that_was_damaged_is_named_and_run_again_once_it_is_deleted(
    drops: Path, tmp_path: Path
) -> None:
    into = tmp_path / "shared"
    shard(drops, into)
    log = a_log(into)
    data = bytearray(log.read_bytes())
    data[len(data) // 2] ^= 1
    log.write_bytes(data)
    found = merge(into, tmp_path / "runs")
    assert isinstance(found, Missing)
    assert len(found.cells) == 1
    assert [sentence.split(":")[0] for sentence in found.damaged] == [str(log)]
    log.unlink()
    assert shard(drops, into).ran == 1
    assert contents(merged(into)) == contents(run(drops, tmp_path / "whole").run)


def test_two_logs_of_one_cell_that_differ_are_refused(drops: Path, tmp_path: Path) -> None:
    """As a machine would leave that computes otherwise: its log is whole, and another."""
    into = tmp_path / "shared"
    shard(drops, into)
    other = shard(drops, tmp_path / "elsewhere").shard
    notes = other / "ended.jsonl"
    rows = [json.loads(line) for line in notes.read_text().splitlines()]
    for row in rows:
        row["log"]["sha256"] = "0" * 64
    notes.write_text("".join(json.dumps(row) + "\n" for row in rows))
    other.rename(into / "shards" / "another")
    with pytest.raises(TraceError, match="one cell, but not the same bytes"):
        merge(into, tmp_path / "runs")
