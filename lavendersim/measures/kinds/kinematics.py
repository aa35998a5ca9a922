"""Displacements, speeds, rotations and times of rest, from logged poses alone.

Times are counted in steps: logged times are whole nanoseconds, rounded down.
"""

from __future__ import annotations

import math

import numpy as np

from lavendersim.cell import changes_of_bodies
from lavendersim.errors import UsageError
from lavendersim.geometry.bodies import mass_of
from lavendersim.geometry.rotations import rotation_matrix, turns_between, unit_quaternion
from lavendersim.measures.columns import body_columns
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import kinematics as specs

NAN = float("nan")
ROUNDED = 2e-9  # [s] logged times are rounded down to nanoseconds


@measure(specs.Displacement)
def displacement(spec: specs.Displacement, trace: Trace) -> float:
    """Return how far [m] the centre came along the direction; NaN when the run ends before."""
    rows = _rows(trace, spec.begin, spec.end)
    return _displacement(trace, spec, rows) if rows else NAN


@measure(specs.MeanVelocity)
def mean_velocity(spec: specs.MeanVelocity, trace: Trace) -> float:
    """Return that displacement over its time [m/s]."""
    rows = _rows(trace, spec.begin, spec.end)
    return _displacement(trace, spec, rows) / _seconds(trace, *rows) if rows else NAN


@measure(specs.MeanAngularVelocity)
def mean_angular_velocity(spec: specs.MeanAngularVelocity, trace: Trace) -> float:
    """Return the sum of the turns between neighbouring states, along the direction, over time.

    q' q^-1 = (cos(a/2), u sin(a/2)) is a turn by a about u; its vector is a u.
    """
    rows = _rows(trace, spec.begin, spec.end)
    if not rows:
        return NAN
    turns = trace.pose[rows[0] : rows[1] + 1, list(trace.bodies).index(spec.body), 3:]
    w, vector = turns_between(turns[:-1], turns[1:])
    size = np.sqrt((vector**2).sum(axis=1))
    # sin(a/2) -> a/2, so a/sin(a/2) -> 2 as the turn goes to zero
    angle = 2.0 * np.arctan2(size, w)
    stretch = np.where(size > 0.0, angle / np.where(size > 0.0, size, 1.0), 2.0)
    along = _unit(spec.along)
    return float((stretch * (vector @ along)).sum()) / _seconds(trace, *rows)


@measure(specs.CentreOfMass)
def centre_of_mass(spec: specs.CentreOfMass, trace: Trace) -> float:
    """Return the mean of sum(m x)/sum(m) along the direction [m], by the trapezoidal rule.

    UsageError where an event changes the mass of one of the bodies; NaN when the run ends before.
    """
    rows = _rows(trace, spec.begin, spec.end)
    columns = [*dict.fromkeys(body_columns(trace, spec.bodies))]  # one may be named twice
    if not rows or not columns:
        return NAN
    names = [trace.bodies[column] for column in columns]
    for event in changes_of_bodies(trace.events):
        if event.body in names and (event.remove or event.scale_mass is not None):
            raise UsageError(f"centre_of_mass takes one mass, and an event changes {event.body}'s")
    masses = np.array([mass_of(trace.config.scene.bodies[name]) for name in names])
    window = slice(rows[0], rows[1] + 1)
    centres = trace.pose[window, columns, :3] @ _unit(spec.along) @ (masses / masses.sum())
    steps = np.asarray(trace.step["step"])[window]
    lengths = trace.clock.elapsed(steps[:-1], steps[1:])
    return float(0.5 * (centres[:-1] + centres[1:]) @ lengths) / _seconds(trace, *rows)


@measure(specs.TopSpeed)
def top_speed(spec: specs.TopSpeed, trace: Trace) -> float:
    """Return the greatest speed [m/s]; NaN when the run ends before `after`."""
    speeds, ends = _speeds(trace, spec.bodies)
    later = speeds[ends > spec.after + ROUNDED]
    return float(np.max(later)) if later.size else NAN


@measure(specs.RestTime)
def rest_time(spec: specs.RestTime, trace: Trace) -> float:
    """Return the end [s] of the last step in which a centre was as fast as the threshold."""
    speeds, ends = _speeds(trace, spec.bodies)
    fast = np.flatnonzero(~(speeds < spec.slower_than))
    if len(fast) == 0:
        return 0.0
    return float(ends[fast[-1]]) if fast[-1] < len(speeds) - 1 else NAN


@measure(specs.Tilt)
def tilt(spec: specs.Tilt, trace: Trace) -> float:
    """Return the angle [degree] between both directions of the axis, good for small ones too."""
    turns = trace.pose[:, list(trace.bodies).index(spec.body), 3:]
    axis = _unit(spec.axis)
    first, last = (rotation_matrix(unit_quaternion(turns[row])) @ axis for row in (0, -1))
    across = np.cross(first, last)
    return math.degrees(math.atan2(math.sqrt(float(across @ across)), float(first @ last)))


def _rows(trace: Trace, begin: float, end: float | None) -> tuple[int, int] | None:
    """Return the first state at or after `begin` and that at or after `end`, where there are."""
    time = np.asarray(trace.step["time"])
    first = int(np.searchsorted(time, begin - ROUNDED))
    last = len(time) - 1 if end is None else int(np.searchsorted(time, end - ROUNDED))
    return (first, last) if first < last < len(time) else None


def _seconds(trace: Trace, first: int, last: int) -> float:
    return float(trace.clock.elapsed(trace.step["step"][first], trace.step["step"][last]))


def _displacement(
    trace: Trace, spec: specs.Displacement | specs.MeanVelocity, rows: tuple[int, int]
) -> float:
    centres = trace.pose[list(rows), list(trace.bodies).index(spec.body), :3]
    return float((centres[1] - centres[0]) @ _unit(spec.along))


def _speeds(trace: Trace, bodies: tuple[str, ...]) -> tuple[Floats, Floats]:
    """Return the fastest centre's speed [m/s] between neighbouring states, and when they end."""
    displacements = np.diff(trace.pose[:, body_columns(trace, bodies), :3], axis=0)
    steps = np.asarray(trace.step["step"])
    seconds = trace.clock.elapsed(steps[:-1], steps[1:])
    speeds: Floats = np.sqrt((displacements**2).sum(axis=2)).max(axis=1) / seconds
    return speeds, np.asarray(trace.step["time"])[1:]


def _unit(direction: tuple[float, float, float]) -> Floats:
    vector = np.asarray(direction, dtype=float)
    unit: Floats = vector / math.sqrt(float(vector @ vector))
    return unit
