"""Components at a time, first passages, fallen bodies and energies, state by state.

Times are counted in steps: logged times are whole nanoseconds, rounded down.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.measures.columns import body_columns, mechanical_energy
from lavendersim.measures.interfaces import Floats, Trace, Value
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import states as specs

NAN = float("nan")
ROUNDED = 2e-9  # [s] logged times are rounded down to nanoseconds

_REDUCTIONS: Final[dict[str, Callable[[Floats], Any]]] = {
    "max": np.max,
    "min": np.min,
    "mean": np.mean,
    "sum": np.sum,
    "count": lambda numbers: np.count_nonzero(~np.isnan(numbers)),
}


@measure(specs.PositionAt)
def position(spec: specs.PositionAt, trace: Trace) -> Value:
    """Return x . along [m] of each body; NaN when the run ends before the time."""
    row = _row(trace, spec.time)
    columns = body_columns(trace, spec.chosen)
    if row is None:
        return _reduced(np.full(len(columns), NAN), spec.reduce)
    return _reduced(trace.pose[row, columns, :3] @ _unit(spec.along), spec.reduce)


@measure(specs.VelocityAt)
def velocity(spec: specs.VelocityAt, trace: Trace) -> Value:
    """Return v . along [m/s] of each body; NaN when the run ends before the time."""
    return _of_velocity(spec, trace, slice(0, 3))


@measure(specs.AngularVelocityAt)
def angular_velocity(spec: specs.AngularVelocityAt, trace: Trace) -> Value:
    """Return omega . along [rad/s] of each body; NaN when the run ends before the time."""
    return _of_velocity(spec, trace, slice(3, 6))


def _of_velocity(
    spec: specs.VelocityAt | specs.AngularVelocityAt, trace: Trace, part: slice
) -> Value:
    row = _row(trace, spec.time)
    columns = body_columns(trace, spec.chosen)
    if row is None:
        return _reduced(np.full(len(columns), NAN), spec.reduce)
    return _reduced(trace.velocity[row, columns, part] @ _unit(spec.along), spec.reduce)


@measure(specs.FirstPassage)
def first_passage(spec: specs.FirstPassage, trace: Trace) -> Value:
    """Return the time [s] of each body's first crossing, NaN without one."""
    columns = body_columns(trace, spec.chosen)
    components = trace.pose[:, columns, :3] @ _unit(spec.along) - spec.level
    steps = np.asarray(trace.step["step"])
    times = float(trace.step["time"][0]) + trace.clock.elapsed(np.full_like(steps, steps[0]), steps)
    found = [_crossing(of_body, times, spec) for of_body in components.T]
    return _reduced(np.array(found), spec.reduce)


def _crossing(above: Floats, times: Floats, spec: specs.FirstPassage) -> float:
    """Return when `above` first changes its sign; a state on the level has not crossed yet."""
    before, after = above[:-1], above[1:]
    rises, falls = (before < 0.0) & (after >= 0.0), (before > 0.0) & (after <= 0.0)
    crosses = {"rising": rises, "falling": falls, "either": rises | falls}[spec.crossing]
    for row in np.flatnonzero(crosses):
        share = before[row] / (before[row] - after[row])
        time = float(times[row] + share * (times[row + 1] - times[row]))
        if time > spec.after:
            return time
    return NAN


@measure(specs.FallenBodies)
def fallen_bodies(spec: specs.FallenBodies, trace: Trace) -> float:
    """Return how many bodies lean by more than the angle; NaN when the run ends before the time."""
    row = _row(trace, spec.time)
    if row is None:
        return NAN
    turns = trace.pose[:, body_columns(trace, spec.bodies), 3:]
    start, then = (rotation_matrices(turns[k]) @ _unit(spec.axis) for k in (0, row))
    across = np.linalg.norm(np.cross(start, then), axis=1)
    angles = np.arctan2(across, (start * then).sum(axis=1))
    if np.isnan(angles).any():
        return NAN
    return float(np.count_nonzero(angles > math.radians(spec.degrees)))


@measure(specs.EnergyAt)
def energy(spec: specs.EnergyAt, trace: Trace) -> float:
    """Return the energy [J] at the time, less that of an earlier one; NaN beyond the run's end."""
    rows = [_row(trace, spec.time)] + ([] if spec.since is None else [_row(trace, spec.since)])
    energies = (
        mechanical_energy(trace)
        if spec.part == "mechanical"
        else np.asarray(trace.step[f"{spec.part}_energy"])
    )
    values = [NAN if row is None else float(energies[row]) for row in rows]
    return values[0] - values[1] if len(values) > 1 else values[0]


def _row(trace: Trace, time: float | None) -> int | None:
    """Return the first state at or after a time, the last without one; None beyond the end."""
    times = np.asarray(trace.step["time"])
    row = len(times) - 1 if time is None else int(np.searchsorted(times, time - ROUNDED))
    return row if row < len(times) else None


def _reduced(numbers: Floats, reduction: str) -> Value:
    if reduction == "row":
        return float(numbers[0]) if len(numbers) == 1 else numbers
    return float(_REDUCTIONS[reduction](numbers))


def _unit(direction: tuple[float, float, float]) -> Floats:
    vector = np.asarray(direction, dtype=float)
    unit: Floats = vector / math.sqrt(float(vector @ vector))
    return unit
