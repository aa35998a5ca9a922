"""A cell that leaves the finite numbers says so, keeps its log, and does not stop the others."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from small_configs import write

import lavendersim
from lavendersim.figures import write_report
from lavendersim.runner import Finished

# At 1e155 m/s^2 a step adds 4.2e152 m/s; from 1.34e154 m/s on, the square of the speed is infinite
# and the ball has no energy any more: after 33 steps.
LAST_STEP = 33
RUNAWAY = """\
question: What does a run look like that leaves the finite numbers?
expected: It names the body, the step and the time.
scene:
  gravity: [0, 0, 1]
  bodies:
    floor: {shape: {kind: plane}}
    bystander: {shape: {kind: sphere, radius: 0.1}, fixed: true, position: [5, 0, 5]}
    runaway: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 1]}
numerics: chapter
duration: 2.0
sweep:
  gravity: {path: scene.gravity, values: [[0, 0, 1], [0, 0, 1e155], [0, 0, 2]]}
"""


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    folder = tmp_path_factory.mktemp("runaway")
    return lavendersim.run(write(folder, RUNAWAY, "runaway.yaml"), root=folder)


def test_the_status_names_body_step_and_time(finished: Finished) -> None:
    status = finished.outcomes[1].status
    assert finished.outcomes[1].steps == LAST_STEP
    assert status.startswith("diverged: body runaway ")
    assert f"step {LAST_STEP} " in status
    assert "t = 0.1375 s" in status
    assert finished.run.cells[1].status == status


def test_the_other_cells_complete(finished: Finished) -> None:
    assert [outcome.status for outcome in finished.outcomes][::2] == ["complete"] * 2
    assert [outcome.steps for outcome in finished.outcomes][::2] == [480] * 2


def test_the_run_is_not_good(finished: Finished) -> None:
    assert finished.good is False
    assert finished.run.finished


def test_the_log_opens_and_ends_at_the_step_that_diverged(finished: Finished) -> None:
    trace = finished.run.cells[1].trace()
    steps = trace.step["step"]
    assert np.array_equal(steps, np.arange(LAST_STEP + 1))
    assert trace.status == finished.outcomes[1].status
    assert len(trace.pose) == len(steps)
    assert np.all(trace.pose[:, trace.bodies.index("bystander"), 2] == 5.0)
    assert trace.pose[-1, trace.bodies.index("runaway"), 2] > 1e150


def test_a_spin_that_cannot_be_solved_is_distinguished_from_one_that_overflows(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    folder = tmp_path_factory.mktemp("spin")
    # 2000 rad/s about an unstable axis are 8 rad in a step of 1/240 s
    spin = """\
scene:
  gravity: 0
  bodies:
    brick:
      shape: {kind: box, size: [1.0, 0.5, 0.2]}
      mass: 1.0
      position: [0, 0, 0]
      angular_velocity: [1000, 2000, 10]
numerics: chapter
duration: 2.0
"""
    finished = lavendersim.run(write(folder, spin, "spin.yaml"), root=folder)
    (outcome,) = finished.outcomes
    assert outcome.status.startswith(
        "diverged: body brick turns too far in one timestep for its rotation to be solved after "
    )


def test_the_log_up_to_there_is_that_of_a_run_that_ends_before(
    finished: Finished, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("before")
    short = RUNAWAY.replace("duration: 2.0", f"duration: {LAST_STEP - 1}/240")
    before = lavendersim.run(write(folder, short, "runaway.yaml"), root=folder)
    assert before.good
    ended, whole = finished.run.cells[1].trace(), before.run.cells[1].trace()
    assert ended.step[:LAST_STEP].tobytes() == whole.step.tobytes()
    assert np.array_equal(ended.pose[:LAST_STEP], whole.pose)


def test_a_diverged_cell_has_its_row_and_picture_in_a_report(
    finished: Finished, tmp_path: Path
) -> None:
    page = tmp_path / "report.html"
    write_report([finished], page)
    text = page.read_text(encoding="utf-8")
    assert "0 of 1 cases pass" in text
    assert f"after step {LAST_STEP} (t = 0.1375 s)" in text
    assert "data:image/png;base64," in text
