"""Samples are the same steps of the same motion every time."""

from __future__ import annotations

from typing import Any

from lavendersim.experiment import load_experiment_text
from lavendersim.runner.timed_engine import Timed
from lavendersim.scene.plan import plan_of
from tests.drop_config import LOW

BALL = f"{LOW}duration: 0.5\n"


class StepClock:
    """A clock that gains 1000 ns with every step an engine has done since its initial state."""

    engine: Any = None

    def __call__(self) -> int:
        return 0 if self.engine is None else 1000 * int(self.engine.counters["step"][0])


def test_a_sample_is_the_same_steps_every_time() -> None:
    cell = load_experiment_text(BALL, "ball.yaml").cells()[0]
    spec = plan_of(cell.config, record=False).spec
    first, steps = 24, 96  # of 120: the ball lands and bounces in them
    clock = StepClock()
    timed = Timed(cell.config, spec, first, steps, clock)
    clock.engine, timed.starts = timed.engine, 3
    timed.set_back()
    begin = timed.engine.bodies["z"].tobytes()
    for _ in range(3):
        assert timed.sample() == 1000.0  # [ns]: of the timed steps alone, not those before
        assert int(timed.engine.counters["step"][0]) == first + steps
        assert timed.engine.bodies["z"].tobytes() != begin
        timed.set_back()
        assert timed.engine.bodies["z"].tobytes() == begin
    assert 0.0 < timed.contacts < 1.0
    whole = Timed(cell.config, spec, 0, first + steps)
    assert whole.motion == timed.motion  # where an uninterrupted run ends, to the bit
