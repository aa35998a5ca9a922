"""Tables of a finished run: what was measured and spent, with all digits, in JSON and in CSV."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.runner.accuracy import Accuracy, Worst
from lavendersim.runner.cell_outcome import CellOutcome
from lavendersim.runner.results import (
    VIOLATIONS,
    compile_seconds,
    convergence_notices,
    write_results,
)
from lavendersim.runner.run_results import read_results
from tests.marked_config import config

EXPERIMENT = load_experiment_text(
    config(
        measure="{m: {kind: simulated_duration}}",
        sweep="{t: {path: duration, values: [1, 2]}}",
    ),
    "a.yaml",
)
WORST = {"cone": Worst(0.25, "floor and ball"), "residual": Worst(1e-3, "")}


def finished(folder: Path, *outcomes: CellOutcome, paths: tuple[str, ...] = ("0", "1")) -> Any:
    cells = [
        SimpleNamespace(index=one.index, label=one.label, coordinates=one.coordinates, path=path)
        for one, path in zip(EXPERIMENT.cells(), paths, strict=True)
    ]
    run = SimpleNamespace(name="a", path=folder, experiment=EXPERIMENT, cells=cells)
    return SimpleNamespace(run=run, outcomes=outcomes, verdicts=[], good=True)


def outcome(cell: int, steps: int = 1000, **accuracy: Any) -> CellOutcome:
    return CellOutcome(cell, "complete", steps, 3_000_000_000, 5_000_000, 2_000_000, Accuracy(**accuracy))  # noqa: E501  # fmt: skip


def test_costs_are_per_step_and_numbers_keep_their_digits(tmp_path: Path) -> None:
    third = 1.0 / 3.0
    given = finished(tmp_path, outcome(0, worst=WORST), outcome(1, steps=0))
    write_results(given, [{"m": third}, {"m": math.nan}])
    first, second = read_results(tmp_path / "results.json").cells
    assert first.measures["m"] == third
    assert math.isnan(second.measures["m"])
    assert (first.physics_us_per_step, first.logging_us_per_step) == (5.0, 2.0)
    assert second.physics_us_per_step == 5000.0  # of no step as if of one
    assert first.compile_s == 3.0
    assert json.loads((tmp_path / "results.json").read_text())["cells"][1]["measures"] == {
        "m": "nan"
    }


def test_violations_are_named_with_their_contact_or_are_nothing(tmp_path: Path) -> None:
    write_results(finished(tmp_path, outcome(0, worst=WORST), outcome(1)), [{}, {}])
    first, second = read_results(tmp_path / "results.json").cells
    assert (first.violations["worst_cone"], first.violations["worst_cone_contact"]) == (0.25, "floor and ball")  # noqa: E501  # fmt: skip
    assert first.violations["worst_residual_contact"] is None
    assert set(second.violations) == set(VIOLATIONS)
    assert set(second.violations.values()) == {None}


def test_both_tables_say_the_same(tmp_path: Path) -> None:
    given = finished(tmp_path, outcome(0, tolerance=1e-9, worst_residual=0.5, not_converged=7, worst=WORST), outcome(1))  # noqa: E501  # fmt: skip
    write_results(given, [{"m": 1.0 / 3.0}, {}])
    with (tmp_path / "results.csv").open(newline="") as file:
        first, second = csv.DictReader(file)
    assert (first["cell"], first["t"], second["t"]) == ("t=1", "1", "2")
    assert float(first["m"]) == 1.0 / 3.0
    assert second["m"] == ""
    assert (first["tolerance"], first["worst_residual"], first["not_converged_steps"]) == ("1e-09", "0.5", "7")  # noqa: E501  # fmt: skip
    assert float(first["worst_cone"]) == 0.25


def test_cells_that_share_a_log_compiled_once(tmp_path: Path) -> None:
    assert compile_seconds(finished(tmp_path, outcome(0), outcome(1))) == 6.0
    assert compile_seconds(finished(tmp_path, outcome(0), outcome(1), paths=("0", "0"))) == 3.0


@pytest.mark.parametrize(("missed", "count"), [(0, 0), (12, 1)])
def test_a_notice_names_cell_steps_tolerance_and_the_worst(
    tmp_path: Path, missed: int, count: int
) -> None:
    given = finished(tmp_path, outcome(0), outcome(1, not_converged=missed, tolerance=1e-9, worst_residual=0.0123))  # noqa: E501  # fmt: skip
    found = convergence_notices(given)
    assert len(found) == count
    if found:
        assert found == [
            "a[t=2]: 12 of 1000 steps ended above the tolerance 1e-09 m/s, worst 0.012 m/s"
        ]
