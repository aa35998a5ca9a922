"""A sample is of the steps alone; an engine that crashes, hangs or refuses loses that sample."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers import timing
from lavendersim.peers.messages import Task
from lavendersim.peers.timing import EngineFailed, TimingServer, TimingTask, sample_of
from tests.engines import BALL

STEP, BUILD = 1000, 10**9  # [ns]


class Clock:
    """Moves only when the engine works."""

    def __init__(self) -> None:
        self.now, self.made, self.steps = 0, 0, 0


def use(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    class World:
        def __init__(self, scene: Any, settings: Any) -> None:
            clock.made += 1
            clock.now += BUILD

        def push(self, loads: Any) -> None:
            clock.now += BUILD

        def step(self) -> None:
            clock.steps += 1
            clock.now += STEP

    module = ModuleType("adapter")
    module.World = World  # type: ignore[attr-defined]
    monkeypatch.setattr(timing, "import_module", lambda name: module)
    monkeypatch.setattr(timing, "process_time_ns", lambda: clock.now)


def task(text: str = BALL, engine: str = "mujoco") -> Task:
    config = load_experiment_text(f"{text}\nengine: {engine}", "ball.yaml").cells()[0].config
    return Task(config.as_json(), engine, {})


PUSHED = BALL.replace("bodies:", "forces: [{body: ball, force: [1, 0, 0], from: 0}]\n  bodies:")


@pytest.mark.parametrize("text", [BALL, PUSHED])
def test_building_the_steps_before_and_forces_are_outside_of_a_sample(
    text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Clock()
    use(clock, monkeypatch)
    assert sample_of(TimingTask(task(text), 10, 20, 5 * 20 * STEP)) == STEP
    # one pass that says how long a pass takes, then as many as fill the shortest time
    assert clock.made == 1 + 5
    assert clock.steps == 6 * (10 + 20)


def test_how_a_sample_goes_wrong_is_reported_and_the_next_is_given(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    server = TimingServer(30.0, "tests.unit.peers.crashing_timing")
    try:
        for engine, reported in (
            ("mujoco-stiff", "crashed: its process was ended by SIGSEGV"),
            ("mujoco-rk4", "crashed: its process exited with 3"),
            ("mujoco-cg", "ValueError: it has no such shape"),
        ):
            with pytest.raises(EngineFailed, match=reported):
                server.sample(TimingTask(Task("", engine, {}), 0, 1, 1))
            assert server.sample(TimingTask(Task("", "mujoco", {}), 0, 1, 1)) == 7.0
    finally:
        server.close()
    assert not [*tmp_path.iterdir()]  # what an engine writes is where its process works


def test_an_engine_that_hangs_is_ended_and_started_anew() -> None:
    server = TimingServer(3.0, "tests.unit.peers.crashing_timing")
    with pytest.raises(EngineFailed, match="hangs: no sample came in 3 s"):
        server.sample(TimingTask(Task("", "mujoco-discrete", {}), 0, 1, 1))
    server.close()
    server.close()  # one that has ended is left alone
