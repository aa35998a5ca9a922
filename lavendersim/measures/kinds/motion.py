"""Apexes, drift, creep, sliding and tunnelling, from logged poses alone."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from lavendersim.cell import Box, Plane
from lavendersim.geometry.bodies import rotation_of, vector
from lavendersim.geometry.shapes import half_space
from lavendersim.measures.changes import constant_gravity
from lavendersim.measures.closed_forms import bounce_height
from lavendersim.measures.columns import (
    body_columns,
    clearance_by_step,
    last_window,
    one_timestep,
)
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.kinds.impact import parabola_vertex
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import motion as specs

NAN = float("nan")


@measure(specs.ApexError)
def apex_error(spec: specs.ApexError, trace: Trace) -> float:
    """Return |apex / (e^(2 k) h) - 1| after bounce k; NaN if the run does not reach it.

    Where e falls with the approach speed, e^(2 k) is the product of the bounces' own squares.
    The apex is the vertex of the parabola through the highest sample of a flight and its
    neighbours, UsageError where the timestep changes among them. A flight begins where the sampled
    clearance has a valley.
    """
    heights = clearance_by_step(trace, spec.body, spec.above)
    falls, rises = heights[1:-1] < heights[:-2], heights[1:-1] <= heights[2:]
    valleys = np.flatnonzero(falls & rises) + 1
    if len(valleys) < spec.bounce:
        return NAN
    start = valleys[spec.bounce - 1]
    end = valleys[spec.bounce] if len(valleys) > spec.bounce else len(heights) - 1
    top = int(start + np.argmax(heights[start : end + 1]))
    if top in (start, end):  # still rising at the end of the run, or at rest
        return NAN
    one_timestep(trace, top - 1, top + 1, "apex_error")
    apex = parabola_vertex(*(float(height) for height in heights[top - 1 : top + 2]))
    bodies = trace.config.scene.bodies
    moving, plane = bodies[spec.body], bodies[spec.above]
    ideal = bounce_height(trace.config, moving, plane, spec.bounce)
    return abs(apex / ideal - 1.0) if ideal > 0.0 else NAN


@measure(specs.Drift)
def drift(spec: specs.Drift, trace: Trace) -> float:
    """Return the greatest distance [m] of any centre from its place at `after`, later in the run.

    NaN when the run ends before that time.
    """
    later = drift_by_step(trace, spec.after, spec.bodies)
    return float(np.max(later)) if len(later) else NAN


def drift_by_step(trace: Trace, after: float, bodies: tuple[str, ...] = ()) -> Floats:
    """Return the greatest distance [m] of any centre, in every logged state from `after` on."""
    time = np.asarray(trace.step["time"])
    # logged times are whole nanoseconds, rounded down
    rows = np.flatnonzero(time > after - 2e-9)
    if len(rows) < 2:
        return np.zeros(0)
    centres = trace.pose[rows[0] :, body_columns(trace, bodies), :3]
    distances: Floats = np.sqrt(((centres - centres[0]) ** 2).sum(axis=2)).max(axis=1)
    return distances


@measure(specs.SlipDistance)
def slip_distance(spec: specs.SlipDistance, trace: Trace) -> float:
    """Return how far [m] the centre is at the end of the run from where the window began."""
    window = _window(trace, spec.last)
    if window is None:
        return NAN
    return _moved(trace, spec.body, window).length


@measure(specs.Creep)
def creep(spec: specs.Creep, trace: Trace) -> float:
    """Return the mean speed [m/s] of the centre over the last window."""
    window = _window(trace, spec.last)
    if window is None:
        return NAN
    moved = _moved(trace, spec.body, window)
    return moved.length / moved.duration


@measure(specs.EffectiveFriction)
def effective_friction(spec: specs.EffectiveFriction, trace: Trace) -> float:
    """Return (g_t - a)/g_n from the mean acceleration a down the slope in the last window.

    a is the second difference of the positions at beginning, middle and end of the window, which
    is exact for a constant acceleration. NaN when gravity does not pull towards the plane,
    UsageError where the timestep or gravity changes within the window.
    """
    window = _window(trace, spec.last)
    normal = half_space(trace.config.scene.bodies[spec.on].shape).normal
    pull = constant_gravity(trace, "effective_friction", window.first + 1 if window else 1)
    into = -float(normal @ pull)
    if window is None or window.last - window.first < 2 or into <= 0.0:
        return NAN
    along = pull + into * normal
    size = math.sqrt(float(along @ along))
    if size == 0.0:
        return NAN
    half = (window.last - window.first) // 2
    rows = [window.last - 2 * half, window.last - half, window.last]
    places = trace.pose[rows, list(trace.bodies).index(spec.body), :3] @ (along / size)
    interval = half * one_timestep(trace, rows[0], rows[2], "effective_friction")
    acceleration = float(places[0] - 2.0 * places[1] + places[2]) / interval**2
    return (size - acceleration) / into


@measure(specs.PassedThrough)
def passed_through(spec: specs.PassedThrough, trace: Trace) -> float:
    """Return how far [m] the centre came behind the middle of the wall; negative: never."""
    wall = trace.config.scene.bodies[spec.wall]
    centres = trace.pose[:, list(trace.bodies).index(spec.body), :3]
    if isinstance(wall.shape, Plane):
        normal, offset = half_space(wall.shape)
        return float(np.max(offset - centres @ normal))
    if not isinstance(wall.shape, Box):
        return NAN
    local = (centres - vector(wall.position)) @ rotation_of(wall)
    outside = np.abs(local[0]) - 0.5 * vector(wall.shape.size)
    edge = int(np.argmax(outside))
    side = -np.sign(local[0, edge])
    return float(np.max(side * local[:, edge])) if outside[edge] > 0.0 else NAN


class _Window(NamedTuple):
    """The end of a run that is looked at, by its states."""

    first: int
    last: int


class _Moved(NamedTuple):
    """How far the centre of a body came in a window."""

    length: float  # [m]
    duration: float  # [s], counted in steps: logged times are whole nanoseconds


def _window(trace: Trace, seconds: float) -> _Window | None:
    """Return the last window; its first state is that in which it begins."""
    rows = np.flatnonzero(last_window(trace, seconds))
    return _Window(int(rows[0]) - 1, int(rows[-1])) if len(rows) and rows[0] > 0 else None


def _moved(trace: Trace, body: str, window: _Window) -> _Moved:
    """Return how far a body came from the first to the last state of a window."""
    places = trace.pose[list(window), list(trace.bodies).index(body), :3]
    first, last = trace.step["step"][list(window)]
    return _Moved(math.dist(*places), float(trace.clock.elapsed(first, last)))
