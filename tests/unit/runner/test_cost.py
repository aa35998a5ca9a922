"""What accuracy costs: errors are the logs' own, failures stay, and a fragment gives its error."""

from __future__ import annotations

import csv
import json
import shutil
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lavendersim.errors import TraceError
from lavendersim.experiment import load_experiment
from lavendersim.experiment.cell import Cell
from lavendersim.figures.work_precision import compose, draw_work_precision
from lavendersim.measures.cost_table import CostRow
from lavendersim.runner import cost_times, open_run, run
from lavendersim.runner.cost import Costed, take_cost
from lavendersim.scene.plan import Plan, plan_of_cell
from tests.bouncing_ball_config import BOUNCING_BALL
from tests.older_runs import without_digests

QUESTION = """\
question: What does a bounce cost?
expected: Finer steps come closer to e^2 h.
"""
COST = """\
  sinking: {kind: max_penetration, body: ball}
expect:
  - {name: the apex is exact, measure: apex, at_most: 0}
  # a step at 2 m/s is 33 mm at 60 Hz and 8 mm at 240 Hz
  - {name: it hardly sinks in, measure: sinking, at_most: 0.01}
cost:
  error: {measure: apex}
  solvers: [projected_gauss_seidel]
  timesteps: [1/60, 1/240]
  sweeps: [4]
  warm_start: [true]
  targets: [0.5, 1e-9]
  repeats: 7
"""
BALL = QUESTION + BOUNCING_BALL + COST


@pytest.fixture(scope="module")
def costed(tmp_path_factory: pytest.TempPathFactory) -> Costed:
    folder = tmp_path_factory.mktemp("cost")
    config = folder / "ball.yaml"
    config.write_text(BALL)
    return take_cost(load_experiment(config), folder / "runs")


def rows_of(costed: Costed) -> dict[tuple[str, str], CostRow]:
    return {(row.role, row.timestep): row for row in costed.table.rows}


def test_errors_are_those_of_the_logs_the_worst_over_the_experiments_own_cells(
    costed: Costed,
) -> None:
    results = costed.finished.run.results()["cells"]
    for place, row in enumerate(costed.table.rows):
        cells = results[3 * place : 3 * place + 3]
        apexes = [cell["measures"]["apex"] for cell in cells]
        assert row.error == max(apexes)
        worst = cells[int(np.argmax(apexes))]["label"]
        assert row.worst_at in worst
        assert row.worst_residual == max(cell["worst_residual"] for cell in cells)
        # captured restitution is off by a share of what is fallen in a step: percents, not zero
        assert 1e-4 < row.error < 1.0


def test_a_setting_that_breaks_a_claim_has_failed_and_stays(costed: Costed) -> None:
    rows = rows_of(costed)
    coarse, fine = rows["grid", "1/60"], rows["grid", "1/240"]
    assert "it hardly sinks in" in coarse.failed
    assert coarse.error is not None
    assert coarse.ns_per_second.median > 0.0
    assert not coarse.front
    # the claim on the error itself is the axis of errors: all of them break it, none fails by it
    assert fine.failed == ""


def test_times_are_kept_sample_by_sample_and_their_spread_is_that_of_the_samples(
    costed: Costed,
) -> None:
    for row in costed.table.rows:
        samples, spread = row.samples, row.ns_per_second
        assert len(samples) == 7 == costed.table.repeats
        assert spread.median == sorted(samples)[3]
        # P(all of seven lie on one side) = 2/128 < 1/20; of six or more on one side, 16/128
        assert (spread.low, spread.high) == (min(samples), max(samples))
        assert row.timed_seconds == pytest.approx(3 * 0.6)
        assert row.compile_s > 0.0
    assert costed.table.machine["processor"]


def test_a_run_of_a_grid_is_finished_and_holds_its_tables(costed: Costed) -> None:
    run_directory = costed.finished.run
    assert run_directory.finished
    assert open_run(None, run_directory.path.parent).path.name == run_directory.path.name
    assert costed.table.as_data() == json.loads((run_directory.path / "cost.json").read_text())
    assert run_directory.cost() == costed.table  # read again, to the last digit
    with (run_directory.path / "cost.csv").open(newline="") as file:
        written = list(csv.DictReader(file))
    assert [float(row["error"]) for row in written] == [row.error for row in costed.table.rows]
    assert [float(row["median"]) for row in written] == [
        row.ns_per_second.median for row in costed.table.rows
    ]


def test_a_table_of_costs_that_lacks_a_number_is_damaged(costed: Costed, tmp_path: Path) -> None:
    whole = costed.finished.run.path
    run = Path(shutil.copytree(whole, tmp_path / whole.name))
    without_digests(run)  # as older runs are; else the digest says it
    table = json.loads((run / "cost.json").read_text())
    del table["rows"][1]["compile_s"]
    (run / "cost.json").write_text(json.dumps(table))
    with pytest.raises(
        TraceError, match=r"cost\.json: damaged: rows\.1\.compile_s: field required$"
    ):
        open_run(run).cost()


def test_the_answer_to_a_target_pasted_into_the_config_gives_that_error_again(
    costed: Costed, tmp_path: Path
) -> None:
    reached, missed = costed.table.targets
    assert reached.reached
    assert reached.sentence.startswith("50 % costs ")
    row = costed.table.rows[reached.row]
    config = tmp_path / "pasted.yaml"
    config.write_text(BALL.replace("numerics: {preset: chapter, slop: 0.002}\n", row.fragment))
    results = run(config, tmp_path / "runs").run.results()["cells"]
    assert max(cell["measures"]["apex"] for cell in results) == row.error
    assert (missed.reached, missed.fragment) == (False, None)
    assert missed.sentence.startswith("no setting of the grid reaches 1e-07 %: the nearest is ")


def test_the_figure_is_drawn_from_the_run_alone(costed: Costed, tmp_path: Path) -> None:
    written = draw_work_precision(costed.finished.run, tmp_path)
    assert [path.name for path in written] == ["ball_cost.png", "ball_cost.svg"]
    assert all(path.stat().st_size > 10_000 for path in written)
    again = draw_work_precision(open_run(costed.finished.run.path), tmp_path / "again")
    assert [path.read_bytes() for path in written] == [path.read_bytes() for path in again]


def test_against_itself_the_truth_is_an_eighth_of_the_finest_step(tmp_path: Path) -> None:
    text = BALL.replace("{measure: apex}", "{measure: sinking, truth: finest, scale: 0.1}")
    config = tmp_path / "ball.yaml"
    config.write_text(text)
    costed = take_cost(load_experiment(config), tmp_path / "runs")
    truth = costed.table.truth
    assert (truth.timestep, truth.tolerance) == ("1/1920", 1e-12)
    cells = costed.finished.run.results()["cells"]
    true = [cell["measures"]["sinking"] for cell in cells[-3:]]
    assert "timestep=1/1920" in cells[-1]["label"]
    for place, row in enumerate(costed.table.rows):  # the truth itself is no row
        values = [cell["measures"]["sinking"] for cell in cells[3 * place : 3 * place + 3]]
        errors = [abs(value - one) / 0.1 for value, one in zip(values, true, strict=True)]
        assert row.error == pytest.approx(max(errors), rel=1e-12)
    assert len(costed.table.rows) == len(cells) // 3 - 1


def test_each_setting_is_planned_once_for_its_clock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is said of compiling them, and what is compiled and timed, are of one plan."""
    planned: list[int] = []

    def noted(cell: Cell, record: bool) -> Plan:
        planned.append(cell.index)
        return plan_of_cell(cell, record)

    monkeypatch.setattr(cost_times, "plan_of_cell", noted)
    config = tmp_path / "ball.yaml"
    config.write_text(BALL)
    costed = take_cost(load_experiment(config), tmp_path / "runs")
    assert planned == list(range(3 * len(costed.table.rows)))


def test_a_setting_that_flies_apart_is_timed_up_to_there_and_stays(tmp_path: Path) -> None:
    # At 1e155 m/s^2 the square of the speed is infinite after 1.34e154 m/s: 0.134 s.
    text = BALL.replace("scene:\n", "scene:\n  gravity: [0, 0, 1e155]\n")
    text = text.replace("phase: {path: scene.bodies.ball.release.phase, values: [0,", "m: {}")
    text = text.replace("m: {} 1/3, 2/3]}", "m: {path: scene.bodies.ball.mass, values: [1, 2, 3]}")
    config = tmp_path / "ball.yaml"
    config.write_text(text)
    costed = take_cost(load_experiment(config), tmp_path / "runs")
    for row in costed.table.rows:
        assert "diverged: body ball" in row.failed
        assert row.error is None
        assert row.ns_per_second.median > 0.0
        step = float(Fraction(row.timestep))
        # whole steps before the one that diverged, in each of three cells
        assert row.timed_seconds <= 3 * 0.1341
        assert row.timed_seconds >= 3 * (0.1341 - 2.0 * step)
    assert "all of them failed" in costed.table.targets[0].sentence
    assert "failed" in [text.get_text() for text in compose(costed.table).axes[0].texts]
