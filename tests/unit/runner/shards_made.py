"""Shards of small sweeps, and the run that they are merged into."""

from __future__ import annotations

from pathlib import Path

from lavendersim.experiment import load_experiment
from lavendersim.runner import Finished, Run
from lavendersim.runner.merge import merge
from lavendersim.runner.shards import ShardRun, run_shard


def shard(config: Path, into: Path, part: tuple[int, int] | None = None) -> ShardRun:
    return run_shard(load_experiment(config), into, part)


def merged(into: Path) -> Run:
    found = merge(into, into.parent / "merged")
    assert isinstance(found, Finished), found
    return found.run
