"""A run reports which steps did not converge, by how far, and goes on all the same."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import lavendersim
from lavendersim.runner import Finished
from lavendersim.runner.accuracy import Accuracy
from tests.runner.small_configs import write

# Two balls, one on the other: W = [[1, -1], [-1, 2]]/m. One sweep without an impulse to start from
# stops the lower ball, then has it carry half of the upper one's g dt: the lower contact is left
# with g dt/2 = 0.02 m/s in the first step. A sweep shrinks what is left by (-1)^2/(1 * 2) = 1/2, so
# of four hundred nothing is left.
TOWER = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.1]}
    high: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.3]}
numerics: {preset: chapter, warm_start: false, tolerance: 1e-9}
duration: 0.25
sweep:
  sweeps: {path: numerics.sweeps, values: [1, 400]}
measure:
  not_converged: {kind: not_converged_steps}
expect:
  - {name: most steps may miss, measure: not_converged, at_most: 60}
"""


def rows(residuals: list[float], not_converged: list[int]) -> np.ndarray:
    made = np.zeros(len(residuals), [("residual", "f8"), ("not_converged", "i8")])
    made["residual"], made["not_converged"] = residuals, not_converged
    return made


def test_steps_are_counted_and_the_worst_is_kept_over_blocks() -> None:
    first = Accuracy(tolerance=1e-8).after(rows([1e-9, 3e-7], [0, 1]))
    both = first.after(rows([2e-8, 1e-8], [1, 0]))
    assert both == Accuracy(worst_residual=3e-7, tolerance=1e-8, not_converged=2)


def test_a_residual_that_is_not_a_number_stays_the_worst() -> None:
    after = Accuracy(tolerance=1e-8).after(rows([math.nan], [1])).after(rows([1e-3], [1]))
    assert math.isnan(after.worst_residual)


def test_without_a_tolerance_nothing_is_missed() -> None:
    assert Accuracy().after(rows([5.0], [1])) == Accuracy(5.0, None, 0)


def finished_with(**cells: Accuracy) -> Any:
    outcomes = [SimpleNamespace(accuracy=one, steps=1200) for one in cells.values()]
    labels = [SimpleNamespace(label=label.replace("_", "=")) for label in cells]
    return SimpleNamespace(run=SimpleNamespace(name="towers", cells=labels), outcomes=outcomes)


@pytest.fixture(scope="module")
def towers(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    folder = tmp_path_factory.mktemp("towers")
    return lavendersim.run(write(folder, TOWER, "towers.yaml"), root=folder)


def test_the_outcome_agrees_with_the_log(towers: Finished) -> None:
    for cell, outcome in zip(towers.run.cells, towers.outcomes, strict=True):
        step = cell.trace().step
        assert outcome.accuracy.not_converged == np.count_nonzero(step["residual"] > 1e-9)
        assert outcome.accuracy.worst_residual == step["residual"].max()
    hasty, patient = (outcome.accuracy for outcome in towers.outcomes)
    assert 0 < hasty.not_converged <= 60
    assert hasty.worst_residual >= 0.5 * 9.81 / 240 * (1 - 1e-12)
    assert patient.not_converged == 0


def test_a_cell_that_missed_is_named_and_fails_nothing(towers: Finished) -> None:
    (notice,) = towers.not_converged
    assert notice.startswith("towers[sweeps=1]: ")
    assert towers.good


def test_both_tables_hold_count_worst_and_tolerance(towers: Finished) -> None:
    with (towers.run.path / "results.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    for row, cell, outcome in zip(
        table, towers.run.results()["cells"], towers.outcomes, strict=True
    ):
        assert (
            int(row["not_converged_steps"])
            == cell["not_converged_steps"]
            == outcome.accuracy.not_converged
        )
        assert float(row["worst_residual"]) == outcome.accuracy.worst_residual
        assert float(row["tolerance"]) == cell["tolerance"] == 1e-9
        assert cell["measures"]["not_converged"] == cell["not_converged_steps"]


def test_what_compiling_costs_stands_once_and_apart(towers: Finished) -> None:
    results = towers.run.results()
    assert results["compile_s"] == pytest.approx(sum(c["compile_s"] for c in results["cells"]))
    for cell in results["cells"]:
        # 61 rows of three bodies: microseconds, where compiling or loading takes milliseconds
        assert 0.0 < cell["physics_us_per_step"] < 1e4
        assert cell["logging_us_per_step"] > 0.0


def test_no_time_that_was_measured_enters_the_log(towers: Finished, tmp_path: Path) -> None:
    again = lavendersim.run(write(tmp_path, TOWER, "towers.yaml"), root=tmp_path)
    for one, other in zip(towers.run.cells, again.run.cells, strict=True):
        assert one.path.read_bytes() == other.path.read_bytes()
    assert again.compile_s != towers.compile_s
