"""Cells run by other executors than our own: pools of Python's, and what only ours writes."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest
from executors import Here

from lavendersim.errors import ConfigError, UsageError
from lavendersim.runner import run
from tests.runner.run_contents import contents
from tests.runner.small_configs import DROPS, write


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    return write(tmp_path)


def test_problems_are_written_by_processes_alone(drops: Path, tmp_path: Path) -> None:
    drops.write_text(DROPS + "record: {problems: every 10}\n")
    with pytest.raises((UsageError, ConfigError), match=r"record\.problems"):
        run(drops, tmp_path / "runs", executor=Here())
    assert not (tmp_path / "runs").exists()


def test_a_pool_of_pythons_own_runs_cells(drops: Path, tmp_path: Path) -> None:
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = run(drops, tmp_path / "runs", executor=pool)
    assert contents(found.run) == contents(run(drops, tmp_path / "whole").run)
