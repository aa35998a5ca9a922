"""Errors and timings of engines on studies: every timed sample and the medians.

One process. First every engine shows every study once, for its errors, untimed. Then come the
repeats: study by study all engines in turn, the order of the engines rotated by one each repeat,
so that a slow minute of the machine falls on all of them. Only `Handle.step` stands between the
two readings of the clock; building, compiling and reading states are outside.
"""

from __future__ import annotations

import gc
from collections.abc import Iterable
from time import perf_counter, perf_counter_ns, process_time_ns
from typing import Any, Final, NamedTuple

import numpy as np

from .adapter import CannotRun, Engine, Handle
from .description import Scene
from .errors import Track
from .studies import Study

READ_RATE: Final = 24.0  # states read per second before the last second [1/s]
BLOCK_SECONDS: Final = 0.1  # simulated time of a timed block [s]
NS_PER_US: Final = 1000.0


class Allowance:
    """Seconds that one engine may step in one study; a run is stopped between steps."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.begin = perf_counter()

    def build(self, engine: Engine, scene: Scene) -> Handle:
        """Build a scene; what that takes, compiling above all, is not counted."""
        begin = perf_counter()
        handle = engine.build(scene)
        self.begin += perf_counter() - begin
        return handle

    def check(self, scene: Scene, done: int) -> None:
        """Raise CannotRun when they are spent."""
        spent = perf_counter() - self.begin
        if spent > self.seconds:
            raise CannotRun(f"stopped at the limit, {spent:.0f} s, at step {done} of {scene.steps}")


class Timing(NamedTuple):
    """One timed run: a row per block, columns steps, wall time [ns], processor time [ns]."""

    blocks: np.ndarray  # (blocks, 3)

    @property
    def per_step(self) -> float:
        """Mean cost of a step over the whole run [us]."""
        return float(self.blocks[:, 1].sum() / self.blocks[:, 0].sum() / NS_PER_US)


class Cost(NamedTuple):
    """Cost of a step [us] out of several runs.

    Engines repeat themselves, so block k of every run is the same work: the median over the runs
    is taken block by block, and what disturbed the machine in a minority of them falls away.
    """

    wall: float
    processor: float  # processor time, all threads: what remains true on a shared machine
    settled: float  # wall, last fifth of the run

    @staticmethod
    def of(timings: list[Timing]) -> Cost:
        """Return the cost over runs with the same blocks."""
        stacked = np.array([timing.blocks for timing in timings], float)
        steps = stacked[0, :, 0]
        wall, used = np.median(stacked[:, :, 1:], axis=0).T / NS_PER_US
        tail = max(1, len(steps) // 5)
        return Cost(
            float(wall.sum() / steps.sum()),
            float(used.sum() / steps.sum()),
            float(wall[-tail:].sum() / steps[-tail:].sum()),
        )


def read_steps(scene: Scene, every_step: bool) -> list[int]:
    """Return the steps after which states are read: all of them in the last second."""
    if every_step:
        return list(range(scene.steps + 1))
    stride = max(1, scene.step_at(1.0 / READ_RATE))
    last = max(0, scene.steps - scene.step_at(1.0))
    half = {scene.step_at(0.5)} if scene.steps >= scene.step_at(0.5) else set()
    return sorted({*range(0, last, stride), *range(last, scene.steps + 1), *half})


def show(engine: Engine, scene: Scene, every_step: bool, allowance: Allowance) -> Track:
    """Run a scene once and keep the states that its errors need."""
    handle = allowance.build(engine, scene)
    try:
        return _watch(handle, scene, every_step, allowance)
    finally:
        handle.close()


def _watch(handle: Handle, scene: Scene, every_step: bool, allowance: Allowance) -> Track:
    read = read_steps(scene, every_step)
    poses, velocities = [], []
    done = 0
    for step in read:
        while done < step:
            # Single steps: an engine that takes seconds for one must not outrun its allowance.
            handle.step(1)
            done += 1
            allowance.check(scene, done)
        poses.append(handle.poses())
        velocities.append(handle.velocities())
        if not np.isfinite(poses[-1]).all():
            raise CannotRun(f"diverged before step {done}")
    return Track(scene, np.array(read), np.array(poses), np.array(velocities))


def time_once(engine: Engine, scene: Scene, allowance: Allowance) -> Timing:
    """Time the steps of one run, block by block."""
    handle = allowance.build(engine, scene)
    size = max(1, scene.step_at(BLOCK_SECONDS))
    blocks: list[tuple[int, int, int]] = []
    done = 0
    gc.collect()
    gc.disable()
    try:
        while done < scene.steps:
            steps = min(size, scene.steps - done)
            used, begin = process_time_ns(), perf_counter_ns()
            handle.step(steps)
            spent = perf_counter_ns() - begin
            blocks.append((steps, spent, process_time_ns() - used))
            done += steps
            allowance.check(scene, done)
    finally:
        gc.enable()
        handle.close()
    return Timing(np.array(blocks))


class Cell:
    """What is known of one engine on one study."""

    def __init__(self) -> None:
        self.errors: dict[str, float | bool] = {}
        self.failure = ""
        self.timings: list[Timing] = []

    def as_json(self) -> dict[str, Any]:
        """Return everything, raw samples and all."""
        per_step = [timing.per_step for timing in self.timings]
        found: dict[str, Any] = {"errors": self.errors, "failure": self.failure}
        if per_step:
            cost = Cost.of(self.timings)
            found |= {
                "us_per_step": cost.wall,
                "us_per_step_processor": cost.processor,
                "us_per_step_settled": cost.settled,
                "us_per_step_runs": per_step,
                "blocks_steps_wall_ns_processor_ns": [t.blocks.tolist() for t in self.timings],
            }
        return found


def measure(
    engines: list[Engine],
    studies: dict[str, Study],
    repeats: int,
    limit: float,
    tell: Any = lambda text: None,
) -> dict[str, dict[str, Any]]:
    """Return study -> variant -> errors and timings. limit: seconds per engine, study and pass."""
    cells = {study: {engine.variant: Cell() for engine in engines} for study in studies}
    for name, study in studies.items():
        for engine in engines:
            cell = cells[name][engine.variant]
            allowance = Allowance(limit)
            try:
                tracks = [show(engine, run, study.every_step, allowance) for run in study.runs]
                cell.errors = study.judge(tracks)
            except CannotRun as error:
                cell.failure = str(error)
            tell(f"{name} {engine.variant}: {cell.failure or _short(cell.errors)}")
    for repeat in range(repeats):
        for name, study in studies.items():
            for engine in _rotated(engines, repeat):
                cell = cells[name][engine.variant]
                if cell.failure:
                    continue
                try:
                    allowance = Allowance(limit)
                    cell.timings.append(time_once(engine, study.runs[study.timed], allowance))
                except CannotRun as error:
                    cell.failure = str(error)
        tell(f"repeat {repeat + 1} of {repeats} done")
    return {
        name: {variant: cell.as_json() for variant, cell in row.items()}
        for name, row in cells.items()
    }


def _rotated(engines: list[Engine], by: int) -> Iterable[Engine]:
    shift = by % len(engines) if engines else 0
    return [*engines[shift:], *engines[:shift]]


def _short(errors: dict[str, float | bool]) -> str:
    return ", ".join(f"{name} {value:.3g}" for name, value in errors.items())
