"""The clock of costs: it sees all that a kernel takes, and nothing of its compilation."""

from __future__ import annotations

from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.runner import cost_times, timed_engine
from lavendersim.runner.cost_times import Clocked, engine_timed, times_of

BALL = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 5]}
numerics: {preset: chapter, timestep: 1/100}
duration: 0.5
"""
RATE, STEPS = 100, 50
COMPILING = 10**12  # [ns] what the double's first call takes, a thousand seconds


class SlowEngine:
    """Stands for an engine whose kernel takes as long as a test sets."""

    def __init__(self, world: World) -> None:
        self.world, self.compiled = world, False
        self.counters = {"step": [0], "contacts": [0]}

    def advance(self, steps: int) -> int:
        if not self.compiled:
            self.compiled = True
            self.world.take(COMPILING)
        self.world.take(steps * self.world.ns_per_step)
        self.counters = {**self.counters, "step": [self.counters["step"][0] + steps]}
        return 0  # RUNNING

    def take_rows(self) -> None:
        pass


class World:
    """A clock that moves only when an engine works."""

    def __init__(self, ns_per_step: int) -> None:
        self.ns_per_step, self.now = ns_per_step, 0

    def take(self, nanoseconds: int) -> None:
        self.now += nanoseconds

    def build(self, resolved: Any, spec: Any) -> Any:
        world = self

        class Scene:
            def engine(self, spec: Any, block_steps: int) -> SlowEngine:
                return SlowEngine(world)

        return Scene()


class RealWorld(World):
    """The processor's own clock, and work that it sees; a compilation is cut to 0.1 s."""

    def take(self, nanoseconds: int) -> None:
        end = timed_engine.clock()[1]() + min(nanoseconds, 10**8)
        while timed_engine.clock()[1]() < end:
            pass


def clocked() -> Clocked:
    (cell,) = load_experiment_text(BALL, "ball.yaml").cells()
    return Clocked([cell], [STEPS], engine_timed([cell]))


def use(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timed_engine, "build", world.build)
    monkeypatch.setattr(
        cost_times,
        "compile_times",
        lambda resolved, specs, workers, report: dict.fromkeys(specs, COMPILING / 1e9),
    )


def silent(what: str, done: int, total: int) -> None:
    pass


@pytest.mark.parametrize("ns_per_step", [1000, 123_457])
def test_a_simulated_second_costs_its_steps_and_nothing_of_the_compilation(
    ns_per_step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World(ns_per_step)
    use(world, monkeypatch)
    monkeypatch.setattr(timed_engine, "clock", lambda: ("fake", lambda: world.now))
    (times,), _ = times_of([clocked()], 0.0, 7, 1, silent)
    assert times.samples == pytest.approx([ns_per_step * RATE] * 7, rel=1e-12)
    assert times.compile_s == COMPILING / 1e9  # it has a number of its own
    assert times.seconds == 0.5
    assert world.now >= COMPILING  # it was compiled, while nobody looked at the clock


def test_the_real_clock_sees_what_a_slow_kernel_burns(monkeypatch: pytest.MonkeyPatch) -> None:
    slow, fast = 200_000, 20_000  # [ns] a step; a sample is 10 ms and 5 runs of 1 ms
    found = []
    for ns_per_step in (slow, fast):
        use(RealWorld(ns_per_step), monkeypatch)
        (times,), _ = times_of([clocked()], 0.0, 7, 1, silent)
        found.append(sorted(times.samples)[3] / RATE)
    # The loop ends when the clock says so: never early, and late by a look at the clock or what the
    # machine adds in a median of seven: less than half. One compilation in it would be ten times.
    assert slow <= found[0] < 1.5 * slow
    assert fast <= found[1] < 1.5 * fast


def test_timing_begins_at_its_step_and_ends_with_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(1000)
    use(world, monkeypatch)
    monkeypatch.setattr(timed_engine, "clock", lambda: ("fake", lambda: world.now))
    (times,), _ = times_of([clocked()], 0.3, 7, 1, silent)
    assert times.seconds == pytest.approx(0.2)
    assert times.samples == pytest.approx([1000 * RATE] * 7, rel=1e-12)


def test_every_round_visits_every_setting_in_turn_forwards_and_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    visits: list[int] = []

    class Visited:
        made = 0

        def __init__(self, *arguments: Any, **options: Any) -> None:
            self.number, self.steps = Visited.made, STEPS
            Visited.made += 1

        def sample(self) -> float:
            visits.append(self.number)
            return 1.0 + self.number

    use(World(1), monkeypatch)
    monkeypatch.setattr(cost_times, "Timed", Visited)
    times, _ = times_of([clocked()] * 3, 0.0, 4, 1, silent)
    assert visits == [0, 1, 2, 2, 1, 0] * 2
    assert [one.samples for one in times] == [[(1.0 + place) * RATE] * 4 for place in range(3)]


def test_several_cells_of_a_setting_cost_their_mean(monkeypatch: pytest.MonkeyPatch) -> None:
    worlds = iter([World(1000), World(3000)])
    clock = World(0)

    def build(resolved: Any, spec: Any) -> Any:
        world = next(worlds)
        world.take = clock.take  # type: ignore[method-assign]
        return world.build(resolved, spec)

    use(clock, monkeypatch)
    monkeypatch.setattr(timed_engine, "build", build)
    monkeypatch.setattr(timed_engine, "clock", lambda: ("fake", lambda: clock.now))
    (cell,) = clocked().cells
    (times,), _ = times_of(
        [Clocked([cell, cell], [STEPS, STEPS], engine_timed([cell]))], 0.0, 7, 1, silent
    )
    assert times.samples == pytest.approx([2000 * RATE] * 7, rel=1e-12)
