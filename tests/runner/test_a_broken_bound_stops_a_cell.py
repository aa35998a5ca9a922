"""A cell stops with the first step that breaks a bound of `always`; the others go on."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import lavendersim
from lavendersim.measures import judge, outcomes_of
from lavendersim.measures.always import PREFIX
from lavendersim.measures.step_checks import StepChecks
from lavendersim.runner import Finished, Run, bounds

# A ball in free flight: after k steps of 1/240 s it is g k / 240 fast, and in step k its centre
# goes g (k - 1/2) / 240 per second: it is faster than 1 m/s first in step 25 of g = 10 m/s^2
# (1.0208), and, with a quarter of the pull, in step 97 (1.0052).
FALLING = """\
scene:
  gravity: [0, 0, -10]
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 9]}
duration: 1.0
sweep:
  pull: {path: scene.gravity.2, values: [-10, -2.5, -1]}
measure:
  duration: {kind: simulated_duration}
expect:
  - {name: lasts, measure: duration, at_least: 1}
"""
FIRST = {"pull=-10": 25, "pull=-2.5": 97, "pull=-1": 240}


def run(folder: Path, text: str, jobs: int = 1) -> Finished:
    config = folder / "falling.yaml"
    config.write_text(text)
    return lavendersim.run(config, root=folder, jobs=jobs)


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_cell_ends_with_the_step_that_breaks_its_bound(tmp_path: Path, jobs: int) -> None:
    finished = run(tmp_path, FALLING + "always: {speed: 1}\n", jobs)
    assert not finished.good
    assert [outcome.steps for outcome in finished.outcomes] == list(FIRST.values())
    for cell in finished.run.cells[:2]:
        trace = cell.trace()
        assert trace.step["step"].tolist() == list(range(FIRST[cell.label] + 1))
        assert len(trace.pose) == len(trace.step)
        assert trace.status.startswith("beyond bounds: speed 1.0")
        assert f"at most 1, ball, in step {FIRST[cell.label]} (t = " in trace.status
    assert finished.run.cells[2].status == "complete"
    assert [cell.label for cell in finished.ended_early] == ["pull=-10", "pull=-2.5"]
    failed = {verdict.node for verdict in finished.verdicts if not verdict.passed}
    assert failed == {
        *("always: speed at pull=-10", "always: speed at pull=-2.5"),
        *("lasts at pull=-10", "lasts at pull=-2.5"),
    }
    table = json.loads((finished.run.path / "results.json").read_text())
    assert [cell["steps"] for cell in table["cells"]] == list(FIRST.values())


def test_without_a_bound_nothing_stops(tmp_path: Path) -> None:
    finished = run(tmp_path, FALLING + "always: {speed: none}\n")
    assert finished.good
    assert [outcome.steps for outcome in finished.outcomes] == [240, 240, 240]


# A ball that bounces, is pushed, thrown, moved and made heavier: every term of the energy balance
# is at work, and 1,200 steps are several blocks of rows. By another one, far away, its plan is that
# of `test_every_step_is_judged`.
BUSY = """\
scene:
  surfaces: {rubber: {friction: 0.3, restitution: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
    ball:
      {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: rubber, position: [0, 0, 0.5]}
    other:
      {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: rubber, position: [0, 90, 0.1]}
  forces: [{body: ball, from: 0.3, to: 4.0, force: [0.4, 1, 1], torque: [0.1, 0, 0.2]}]
events:
  - {at: 0.4, body: ball, teleport: [0.5, 0, 0.7]}
  - {at: 1.4, body: ball, velocity: [0, 0, -2]}
  - {at: 2.45, body: ball, scale_mass: 3}
  - {at: 4.5, body: ball, scale_mass: 0.5}
duration: 5.0
always: {}
"""


def test_blocks_are_judged_as_the_log_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The numbers of the parts are those of the whole log, bit for bit."""
    parts: dict[str, list[np.ndarray]] = {}

    class Kept(StepChecks):
        def over(self, trace):
            again = 1 if trace.step["step"][0] > 0 or parts else 0
            for check in super().over(trace):
                parts.setdefault(check.check, []).append(check.numbers[again:])
                yield check

    monkeypatch.setattr(bounds, "StepChecks", Kept)
    finished = run(tmp_path, BUSY)
    assert finished.good
    (cell,) = finished.run.cells
    always = finished.run.experiment.always
    whole = {one.check: one.numbers for one in StepChecks(always).over(cell.trace())}
    assert len(parts["energy"]) >= 3
    for check, numbers in whole.items():
        assert np.array_equal(np.concatenate(parts[check]), numbers, equal_nan=True), check
    assert all(outcome.passed for outcome in outcomes_of(always, cell).values())


# Free fall that overflows: after k steps of 0.1 s it is 0.1 k 1e308 m/s fast.
DIVERGING = """\
scene:
  gravity: [0, 0, -1.0e+308]
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.5]}
numerics: {timestep: 1/10}
duration: 5.0
always: {stop: false}
"""


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        (BUSY, "complete"),
        (DIVERGING, "diverged"),
        (FALLING + "always: {speed: 1}\n", "beyond bounds"),
        (FALLING + "always: {speed: 1, stop: false}\n", "complete"),
    ],
    ids=["busy", "diverging", "stopped", "not stopped"],
)
def test_a_run_is_judged_as_its_log_is(tmp_path: Path, text: str, ends: str) -> None:
    """Verdicts taken while a cell ran, and those that its log gives when it is opened again."""
    finished = run(tmp_path, text)
    assert finished.outcomes[0].status.startswith(ends)
    experiment = finished.run.experiment
    cells = Run(finished.run.path).cells  # as another process finds them
    assert experiment.always is not None
    logs = {cell.index: outcomes_of(experiment.always, cell) for cell in cells}
    again = judge({}, [], cells, always=experiment.always, outcomes=logs)
    taken = [verdict for verdict in finished.raw if verdict.name.startswith(PREFIX)]
    assert len(taken) == len(again) > 0
    assert [repr(verdict) for verdict in again] == [repr(verdict) for verdict in taken]


def test_a_cell_may_go_on_beyond_a_bound(tmp_path: Path) -> None:
    finished = run(tmp_path, FALLING + "always: {speed: 1, stop: false}\n")
    assert [outcome.steps for outcome in finished.outcomes] == [240, 240, 240]
    assert finished.ended_early == []
    failed = {verdict.node for verdict in finished.verdicts if not verdict.passed}
    assert failed == {"always: speed at pull=-10", "always: speed at pull=-2.5"}
