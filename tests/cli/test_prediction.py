"""Long and large runs are announced, and begin when somebody has said so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from command_line import lavender
from typer.testing import CliRunner, Result

from lavender_cli import prediction
from lavender_cli.main import app
from lavendersim import open_run
from lavendersim.errors import UsageError
from lavendersim.experiment import Experiment, load_experiment
from lavendersim.runner import cell_jobs
from lavendersim.runner import prediction as predictions
from lavendersim.runner.cell_jobs import Prepared
from lavendersim.runner.cost import grid_of
from lavendersim.runner.prediction import PER_CELL, PER_CONTACT, PER_STEP, predicted

# 96,000,000 steps a cell, 10 cells: an hour or so, and logs of hundreds of GB.
LONG = "sweep: {mass: {path: scene.bodies.ball.mass, values: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]}}\n"


@pytest.fixture
def long_one(drop: Path) -> Path:
    text = drop.read_text().replace("duration: 0.5", "duration: 400000")
    drop.write_text(text + LONG)
    return drop


COST = """cost:
  error: {measure: rebound}
  solvers: [projected_gauss_seidel]
  timesteps: [1/60, 1/240]
  sweeps: [4]
  warm_start: [true]
  repeats: 7
"""
TRUTH = "{measure: rebound, truth: 0.025}"


@pytest.mark.parametrize(
    ("words", "steps"),
    [
        (["run", "--refine"], 7 * 960),
        (["check"], 960),
        (["check", "--refine"], 7 * 960),  # at h, h/2 and h/4
        (["check", "--solver", "jacobi,adaptive"], 2 * 960),
    ],
    ids=["run refined", "check", "check refined", "a matrix"],
)
def test_all_that_a_command_runs_is_counted(
    long_one: Path, tmp_path: Path, words: list[str], steps: int
) -> None:
    if "--solver" in words:  # the chapter's numerics are of one solver
        long_one.write_text(long_one.read_text().replace("numerics: chapter", "numerics: default"))
    done = lavender(words[0], long_one, *words[1:], where=tmp_path)
    assert done.returncode == 2
    assert f"{steps * 10**6:,} steps, about " in done.stderr
    assert done.stderr.splitlines()[-1].endswith("say --yes, or set LAVENDER_YES=1")
    assert not (tmp_path / "runs").exists()


def test_cost_counts_its_grid(long_one: Path, tmp_path: Path) -> None:
    long_one.write_text(long_one.read_text() + COST)
    settings = grid_of(load_experiment(long_one)).cells()
    steps = sum(400_000 / cell.config.numerics.timestep for cell in settings)
    done = lavender("cost", long_one, where=tmp_path)
    assert done.returncode == 2
    assert f"drop: {len(settings)} cells, {int(steps):,} steps, about " in done.stderr
    assert done.stderr.splitlines()[-1].endswith("say --yes, or set LAVENDER_YES=1")
    assert not (tmp_path / "runs").exists()


def asked(config: Path, runs: Path, monkeypatch: pytest.MonkeyPatch, answer: str) -> Result:
    """Let a small run count as long, before a terminal where somebody answers."""
    monkeypatch.setattr(predictions, "LONGEST", 0.0)
    monkeypatch.setattr(prediction, "_somebody_answers", lambda: True)
    return CliRunner().invoke(app, ["run", str(config), "--runs", str(runs)], input=answer)


def test_where_nobody_can_be_asked_a_long_run_is_refused(long_one: Path, tmp_path: Path) -> None:
    done = lavender("run", long_one, where=tmp_path)
    assert done.returncode == 2
    announced, refused = done.stderr.splitlines()[-2:]
    assert announced.startswith("drop: 10 cells, 960,000,000 steps, about ")
    assert " of logs" in announced
    assert refused.endswith("nothing has begun: say --yes, or set LAVENDER_YES=1")
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize(("answer", "begins"), [("y\n", True), ("n\n", False), ("", False)])
def test_where_somebody_answers_it_is_asked(
    drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str, begins: bool
) -> None:
    done = asked(drop, tmp_path / "runs", monkeypatch, answer)
    assert (done.exit_code == 0) == begins
    assert (tmp_path / "runs").exists() == begins
    if answer.startswith("n"):
        assert isinstance(done.exception, UsageError)


@pytest.mark.parametrize("how", ["--yes", "LAVENDER_YES"])
def test_who_says_so_before_is_not_asked(
    drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    monkeypatch.setattr(predictions, "LONGEST", 0.0)
    arguments = ["run", str(drop), "--runs", str(tmp_path / "runs")]
    if how == "--yes":
        done = CliRunner().invoke(app, [*arguments, how])
    else:
        done = CliRunner().invoke(app, arguments, env={how: "1"})
    assert done.exit_code == 0, done.output


def test_a_short_run_says_nothing(drop: Path, tmp_path: Path) -> None:
    assert "steps, about" not in lavender("run", drop, where=tmp_path).stderr


def test_the_time_goes_with_steps_cells_and_processes(drop: Path, tmp_path: Path) -> None:
    """One ball on a plane has at most one contact; 0.5 s at 240 Hz are 120 steps."""
    one = predicted(load_experiment(drop), tmp_path)
    assert (one.cells, one.steps) == (1, 120)
    each = one.seconds
    assert 120 * PER_STEP + PER_CELL <= each <= 120 * (PER_STEP + PER_CONTACT) + PER_CELL
    drop.write_text(drop.read_text() + LONG)
    ten = load_experiment(drop)
    assert predicted(ten, tmp_path).seconds == pytest.approx(10 * each, rel=1e-12)
    assert predicted(ten, tmp_path, 2).seconds == pytest.approx(5 * each, rel=1e-12)


@pytest.mark.parametrize("words", [["run"], ["check"], ["cost", "--no-plot"]], ids=lambda w: w[0])
def test_cells_that_processes_plan_are_planned_once_and_before_the_prediction(
    drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str]
) -> None:
    """What is predicted and what is run are the cells of one preparation."""
    drop.write_text(drop.read_text() + COST.replace("{measure: rebound}", TRUTH))
    prepared, known = [], []
    prepare, together = cell_jobs.prepare, predictions.predicted_together

    def preparing(experiment: Experiment, workers: int = 1) -> Prepared:
        prepared.append(prepare(experiment, workers))
        return prepared[-1]

    def predicting(*given: Any) -> Any:
        known.extend(given[3])
        return together(*given)

    monkeypatch.setattr(predictions, "are_shared", lambda cells, workers: True)
    monkeypatch.setattr(cell_jobs, "prepare", preparing)
    monkeypatch.setattr(predictions, "predicted_together", predicting)
    asked = [words[0], str(drop), *words[1:], "--runs", str(tmp_path / "runs")]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    assert len(prepared) == len(known) == 1
    assert known[0] is prepared[0]
    assert open_run(tmp_path / "runs" / "latest").cells[0].path.name in prepared[0].logs
