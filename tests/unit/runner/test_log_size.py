"""About how large a log will be: against logs that were written, and against the disk."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from lavender_cli.main import app
from lavendersim.experiment import load_experiment
from lavendersim.runner import run
from lavendersim.runner.log_size import expected_log_sizes, most_bytes
from lavendersim.runner.plans import shared_plans

CONFIGS = Path(__file__).parents[3] / "configs"
# Of each kind of content one: what falls, rests, spins without contacts, is many without gravity,
# moves on springs.
KINDS = (
    "chapter/impact_telemetry",
    "scenes/rest",
    "scenes/stack_of_six",
    "cost/free_rotation",
    "hard/crowd/rush_to_the_centre",
    "effects/spring",
)
# The shares that zstd leaves lie between those of rest and of churning, which are at most 5 times
# (contacts: 0.1 and 0.46) and 3 times (/step: 0.3 and 0.8) apart: from between, within 2.3.
# The number of contacts is right where bodies rest, else within what they may have: 3 in all.
FACTOR = 3.0


@pytest.mark.parametrize("name", KINDS)
def test_the_expected_size_is_within_a_factor_of_three(name: str, tmp_path: Path) -> None:
    experiment = load_experiment(CONFIGS / f"{name}.yaml", reduced=True)
    cells = experiment.cells()
    expected = expected_log_sizes(cells, shared_plans(cells), experiment.text)
    finished = run(experiment, tmp_path / "runs", overheads=False)
    found = [cell.path.stat().st_size for cell in finished.run.cells]
    for cell, size, real in zip(finished.run.cells, expected, found, strict=True):
        if cell.status == "complete":
            assert real / FACTOR <= size <= real * FACTOR, cell.label
    assert sum(found) <= sum(map(most_bytes, cells))


def test_logged_sweeps_are_counted_as_the_most_there_may_be(tmp_path: Path) -> None:
    """How many a tolerance leaves of them is not known before: where it leaves few, less comes."""
    experiment = load_experiment(CONFIGS / "cost" / "residual_by_sweep.yaml", reduced=True)
    cells = experiment.cells()
    expected = expected_log_sizes(cells, shared_plans(cells), experiment.text)
    finished = run(experiment, tmp_path / "runs", overheads=False)
    all_done = 0
    for cell, size in zip(finished.run.cells, expected, strict=True):
        real = cell.path.stat().st_size
        assert size >= real / FACTOR, cell.label
        log = cell.trace()
        if np.mean(log.step["sweeps"][1:]) > 0.9 * log.config.numerics.sweeps:
            all_done += 1
            assert size <= FACTOR * real, cell.label
    assert all_done


@pytest.mark.parametrize("verb", ["run", "check"])
def test_logs_of_more_than_a_tenth_of_the_free_disk_are_warned_of(
    verb: str, drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    experiment = load_experiment(drop)
    cells = experiment.cells()
    (size,) = expected_log_sizes(cells, shared_plans(cells), experiment.text)
    asked: list[Path] = []

    def warned(free: float) -> str:
        def disk_usage(path: Path) -> SimpleNamespace:
            asked.append(path)
            return SimpleNamespace(total=10**15, used=0, free=free)

        monkeypatch.setattr(shutil, "disk_usage", disk_usage)
        words = [verb, "--yes", str(drop), "--runs", str(tmp_path / "a" / "b")]
        done = CliRunner().invoke(app, words)
        assert done.exit_code == 0
        return "".join(
            line
            for line in done.stderr.splitlines(True)
            if " of logs" in line or "logs take" in line
        )

    assert warned(10 * size + 10) == ""
    # in one sentence, once
    said = r"drop: 1 cell, 120 steps, about .* of logs \(.* are free\), about 0 s"
    assert re.fullmatch(said, warned(10 * size - 10).removesuffix("\n"))
    assert warned(10**15) == ""
    # `runs` is asked where it will be, also before it is made
    assert asked[0] == tmp_path
    assert asked[-1] == tmp_path / "a" / "b"
    assert set(asked) == {tmp_path, tmp_path / "a" / "b"}
