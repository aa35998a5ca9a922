"""What a run will take, by its steps and cells; which runs are not worth a word."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.experiment import cell as cell_module
from lavendersim.runner import cell_jobs, planning, run, workers
from lavendersim.runner.log_size import LogSpace
from lavendersim.runner.prediction import (
    LONGEST,
    PER_CELL,
    PER_PROCESS,
    PER_STEP,
    WORTH_SAYING,
    Prediction,
    is_short,
    planned_before,
    predicted,
    predicted_together,
    seconds_of,
)
from tests.drop_config import DROP


def drop(duration: str, cells: int = 1) -> Experiment:
    """Return drops of a ball."""
    values = ", ".join(str(0.01 * (k + 1)) for k in range(cells))
    sweep = f"sweep: {{e: {{path: scene.bodies.ball.surface.restitution, values: [{values}]}}}}\n"
    text = DROP.replace("duration: 0.5", f"duration: {duration}")
    return load_experiment_text(text + (sweep if cells > 1 else ""), "drop.yaml")


def test_a_drop_is_short_and_an_hour_of_it_is_not(tmp_path: Path) -> None:
    assert is_short(drop("0.5"), tmp_path)
    assert not is_short(drop("200000"), tmp_path)


def test_twice_the_cells_are_twice_the_steps_and_the_time(tmp_path: Path) -> None:
    one, two = predicted(drop("1", 2), tmp_path), predicted(drop("1", 4), tmp_path)
    assert (one.cells, two.cells) == (2, 4)
    assert two.steps == 2 * one.steps
    assert two.seconds == pytest.approx(2.0 * one.seconds, rel=1e-12)
    assert one.seconds >= one.steps * PER_STEP + 2 * PER_CELL


def test_processes_share_cells_and_no_more_than_there_are(tmp_path: Path) -> None:
    experiment = drop("1", 4)
    alone = predicted(experiment, tmp_path).seconds
    assert predicted(experiment, tmp_path, jobs=2).seconds == pytest.approx(alone / 2, rel=1e-12)
    assert predicted(experiment, tmp_path, jobs=9).seconds == pytest.approx(alone / 4, rel=1e-12)


def test_runs_one_after_the_other_take_their_sum(tmp_path: Path) -> None:
    assert predicted_together([drop("0.5")], tmp_path) is None
    runs = [drop("200000"), drop("0.5")]
    whole = predicted_together(runs, tmp_path)
    assert whole is not None
    each = [predicted(one, tmp_path) for one in runs]
    assert whole.steps == sum(one.steps for one in each)
    assert whole.seconds == pytest.approx(sum(one.seconds for one in each), rel=1e-12)
    assert whole.name == runs[0].name


def test_an_hour_is_asked_about_and_a_minute_worth_saying() -> None:
    space = LogSpace(None, 1)
    small = Prediction("a", 1, 1, WORTH_SAYING, space)
    assert not small.is_worth_saying
    assert not small._replace(seconds=LONGEST).is_long
    assert small._replace(seconds=LONGEST + 1.0).is_long


def test_few_cells_and_those_of_one_process_wait_for_their_run() -> None:
    assert planned_before(drop("0.5", 4), jobs=2) is None
    assert planned_before(drop("0.5", 4), jobs=1) is None


@pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux")
def test_cells_are_built_by_the_processes_that_plan_them_and_planned_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(planning, "WORTH_PROCESSES", 2)
    for module in (planning, workers):
        monkeypatch.setattr(module, "may_fork", lambda: True)
    here, build = os.getpid(), cell_module.build_cell

    def elsewhere(*given: Any) -> Any:
        assert os.getpid() != here
        return build(*given)

    experiment = drop("0.02", 4).refined(2)  # none of its cells is built yet
    monkeypatch.setattr(cell_module, "build_cell", elsewhere)
    known = planned_before(experiment, jobs=2)
    assert known is not None
    by_plans, anew = (
        predicted(experiment, tmp_path, 2, known.plans),
        predicted(experiment, tmp_path, 2),
    )
    # Others write to the disk meanwhile.
    assert by_plans._replace(space=by_plans.space._replace(free=0)) == anew._replace(
        space=anew.space._replace(free=0)
    )
    monkeypatch.setattr(cell_jobs, "prepare", None)  # a second time it would be called
    finished = run(experiment, tmp_path, prepared=known, is_predicted=True)
    assert [cell.path.name for cell in finished.run.cells] == known.logs


def test_cells_of_another_engine_take_a_process_each() -> None:
    """Of a short run that is nearly all; so many drops by engines are asked about, not of ours."""
    own: Any = drop("0.01").cells()[0].config
    other: Any = SimpleNamespace(engine="mujoco", steps=own.steps)
    assert seconds_of(other, 0.0) == pytest.approx(PER_PROCESS, rel=0.01)
    many = LONGEST / PER_PROCESS
    assert many * seconds_of(own, 0.0) < WORTH_SAYING < LONGEST < many * seconds_of(other, 0.0)
