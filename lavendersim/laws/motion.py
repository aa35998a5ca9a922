"""What is judged of a run: where its bodies were, and how fast, before and after each step."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import CellConfig, CellEvent, Plane, changes_of_bodies
from lavendersim.clock import Clock
from lavendersim.errors import TraceError, UsageError
from lavendersim.experiment.load import load_experiment_text
from lavendersim.geometry.bodies import is_movable
from lavendersim.quantities.found import nearest, quoted
from lavendersim.quantities.scalars import exact
from lavendersim.scene.body_rows import pose_of
from lavendersim.trace import Trace, open_trace
from lavendersim.trace.motion_log import MotionLog, is_own, read_motion_log

Floats = NDArray[np.float64]


class RecordedMotion(NamedTuple):
    """The recorded states of a run, in order."""

    path: Path  # of its log
    config: CellConfig
    bodies: tuple[str, ...]  # in the order of the config
    clock: Clock
    steps: NDArray[np.int64]  # (rows,) steps done in each state
    pose: Floats  # (rows, bodies, 7) x y z [m], quaternion w x y z
    velocity: Floats  # (rows, bodies, 6) of centres [m/s], spins in world axes [rad/s]


def motion_of(trace: Trace) -> RecordedMotion:
    """Return what a log has of it. UsageError where it has not every velocity or pose."""
    rows = trace.recorded_pose.rows
    steps = np.asarray(trace.step["step"], np.int64)[rows]
    velocity = np.concatenate([one for _, one in trace.velocities_in_parts()])
    return RecordedMotion(
        trace.path,
        trace.config,
        tuple(trace.bodies),
        trace.clock,
        steps,
        trace.recorded_pose.pose,
        velocity,
    )


def read_motion(path: str | Path) -> RecordedMotion:
    """Return the motion of a log, lavender's or another program's (`trace.motion_log`).

    TraceError where it is damaged or lacks something, ConfigError where its config is wrong.
    """
    path = Path(path)
    return motion_of(open_trace(path)) if is_own(path) else _of_others(path)


def _of_others(path: Path) -> RecordedMotion:
    log = read_motion_log(path)
    config = _config_of(path, log)
    described = config.scene.bodies
    for name in log.bodies:
        if name not in described:
            raise TraceError(
                f"{path}: /tf has {quoted(name)}, and no body of the config is called so"
                f"{nearest(name, described)}"
            )
    pose = np.empty((len(log.times), len(described), 7))
    velocity = np.zeros((len(log.times), len(described), 6))
    for row, (name, body) in enumerate(described.items()):
        if name in log.bodies:
            pose[:, row] = log.pose[:, log.bodies.index(name)]
            velocity[:, row] = log.velocity[:, log.bodies.index(name)]
        elif is_movable(body):
            raise TraceError(f"{path}: no message of /tf has the body {quoted(name)}, which moves")
        else:
            pose[:, row] = pose_of(body)
        if isinstance(body.shape, Plane):
            velocity[:, row] = 0.0
    missing = np.argwhere(~np.isfinite(pose).all(axis=2) | ~np.isfinite(velocity).all(axis=2))
    if len(missing):
        k, row = missing[0]
        where = f"the state at {log.times[k]} ns has no finite pose and velocity of"
        raise TraceError(f"{path}: {where} {quoted(list(described)[row])}")
    steps = np.array([_step_at(path, config.clock, int(time)) for time in log.times], np.int64)
    return RecordedMotion(path, config, tuple(described), config.clock, steps, pose, velocity)


def _config_of(path: Path, log: MotionLog) -> CellConfig:
    if log.resolved:
        try:
            return CellConfig.from_dict(json.loads(log.config))
        except ValueError as error:
            why = ": ".join(line.strip() for line in str(error).splitlines()[1:3])
            raise TraceError(f"{path}: its config is none of this version: {why}") from None
    cells = load_experiment_text(log.config, f"{path}/config.yaml").cells()
    if len(cells) != 1:
        raise TraceError(f"{path}: its config has {len(cells)} cells; a log is one of them")
    return cells[0].config


def _step_at(path: Path, clock: Clock, time: int) -> int:
    """Return how many steps are done at a time [ns]; writers may have it rounded to a us."""
    tolerance = min(Fraction(1, 1_000_000), clock.timestep / 4)
    exactly = Fraction(time, 1_000_000_000)
    step = clock.steps_within(exactly + tolerance)
    if abs(clock.time(step) - exactly) > tolerance:
        raise TraceError(
            f"{path}: log_time {time} ns is the end of no step; by the config's timestep of "
            f"{clock.timestep} s step {step} ends at {float(clock.time(step)):.9g} s"
        )
    return step


def first_step_after(motion: RecordedMotion, time: float) -> int:
    """Return the number of the first step that starts at a time [s] as written, or later."""
    return motion.clock.steps_until(exact(time)) + 1


def changed(motion: RecordedMotion) -> dict[int, set[str]]:
    """Return the bodies whose velocity, pose or mass an event changes, by the step that it opens.

    What was before that step is in no log: it is not judged for these bodies.
    """
    found: dict[int, set[str]] = {}
    for event in changes_of_bodies(motion.config.events):
        if _jumps(event):
            found.setdefault(first_step_after(motion, event.at), set()).add(event.body)
    return found


def _jumps(event: CellEvent) -> bool:
    moved = (event.teleport, event.orientation, event.velocity, event.angular_velocity)
    return event.remove or event.scale_mass is not None or any(one is not None for one in moved)


def pairs_of_states(motion: RecordedMotion) -> list[int]:
    """Return the rows of states that are one step after the row before. UsageError: none are."""
    rows = [int(k) + 1 for k in np.flatnonzero(np.diff(motion.steps) == 1)]
    if not rows:
        raise UsageError(
            f"{motion.path}: a step is judged by the states before and after it; "
            "this log has no two states that are one step apart"
        )
    return rows
