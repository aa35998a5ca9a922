"""Events that states make happen: in the log at their time, balanced, and the same in any calls."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lavendersim
from lavendersim.cell import CellEvent, CellGravity
from lavendersim.measures import outcomes_of
from lavendersim.measures.specs.always import Always
from lavendersim.runner import Finished
from lavendersim.runner.call_length import CallLength
from lavendersim.trace import Trace, open_trace

SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.6]}
events:
  - {at: 0.05, body: ball, velocity: [0.1, 0, 0]}
  - {when: {touches: [ball, floor]}, body: ball, velocity: [0, 0, 4]}
  - {when: {body: ball, above: 0.7}, body: ball, scale_mass: 3}
  - {when: {body: ball, faster_than: 50}, body: ball, remove: true}
  - {when: {leaves: [floor, ball]}, gravity: [0, 0, -2]}
duration: 1.0
always: {}
"""


def run(folder: Path) -> Finished:
    config = folder / "touch.yaml"
    config.write_text(SCENE)
    return lavendersim.run(config, root=folder)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    return run(tmp_path_factory.mktemp("triggered"))


def log_of(finished: Finished) -> Trace:
    return open_trace(finished.run.cells[0].path)


def test_the_log_has_what_happened_at_the_times_at_which_it_did(finished: Finished) -> None:
    trace = log_of(finished)
    touch = int(trace.contact["step"][trace.contact["impulse_n"] > 0.0][0])
    high = int(np.argmax(trace.pose[:, 1, 2] > 0.7))
    timed, kick, heavy, light = trace.events
    times = np.array([touch, high, touch + 1]) / 240
    assert [one.at for one in (kick, heavy, light)] == pytest.approx(times, rel=3e-16)
    assert timed.at == 0.05
    assert isinstance(kick, CellEvent)
    assert kick.velocity == (0.0, 0.0, 4.0)
    assert isinstance(light, CellGravity)
    assert trace.step["triggered"][[touch, high, touch + 1]].tolist() == [0b1, 0b10, 0b1000]
    assert finished.run.cells[0].trace().events == trace.events


def test_the_ball_flies_by_what_happened(finished: Finished) -> None:
    """4 m/s from the touch on, under 9.81 m/s^2 for one step and 2 m/s^2 after it: to round-off."""
    trace = log_of(finished)
    touch = int(np.argmax(trace.step["triggered"] == 1))
    left = 1.0 - touch / 240
    height = float(trace.pose[touch, 1, 2])
    first = 4.0 / 240 - 9.81 / 240**2 / 2
    speed, rest = 4.0 - 9.81 / 240, left - 1 / 240
    expected = height + first + speed * rest - rest**2
    assert float(trace.pose[-1, 1, 2]) == pytest.approx(expected, abs=240 * 4.4e-16)


class Forgetful:
    """The cell of a log that does not know what states made happen."""

    index, label, coordinates = 0, "", {}
    path = Path("cell.mcap")

    def __init__(self, trace: Trace) -> None:
        self._trace, self.events = trace, trace.config.events

    def __getattr__(self, name: str) -> Any:
        return getattr(self._trace, name)

    def trace(self) -> Any:
        return self


def test_energy_is_balanced_over_what_states_made_happen(finished: Finished) -> None:
    """The kick gives 8 J; without it they would come from nowhere."""
    assert finished.good
    broken = outcomes_of(Always(stop=False), Forgetful(log_of(finished)))
    assert {name for name, outcome in broken.items() if not outcome.passed} >= {"energy"}


@pytest.mark.parametrize("steps", [1, 7])
def test_a_log_is_the_same_whatever_the_calls(
    steps: int, finished: Finished, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(CallLength, "__init__", lambda self, bodies: setattr(self, "steps", steps))
    monkeypatch.setattr(CallLength, "after", lambda self, made, seconds: None)
    again = log_of(run(tmp_path))
    expected = log_of(finished)
    assert again.step.tobytes() == expected.step.tobytes()
    assert again.pose.tobytes() == expected.pose.tobytes()
    assert again.events == expected.events
