"""Drag of bodies that contacts push, by the velocities of both ends of the step (`effects.drag`).

    v' = v - (x/2) (v_0 + (1 + x) v') / (1 + x/2),   x = h (c1 + c2 |v_0 + v'|/2),   h = dt/m
v: what other forces and the impulses of contacts lead v_0 to. It is drag's own map of a step,
    v' = (v_0 + (1 + x/2) (v - v_0)) / (1 + x + x^2/2),
solved for where the step ends: as v' comes from a solve, passes at the middle of the step find it.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .compile import kernel
from .midpoint_rows import SAME, STILL
from .records import PLANE
from .rotation import to_body, to_world
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, length, minus


def make_slow_by_mean(spec: Spec) -> Any:
    """Return `kernel(body, v, start, params) -> (linear, angular)` of drag [m/s], [rad/s].

    By the velocities of both ends of a step, of which v is that after drag.
    """
    turns = step_terms(spec).turns

    def given(begin, end, x):
        # What `decayed` adds to what other forces do, by where the step ends.
        return -0.5 * x * (begin + (1.0 + x) * end) / (1.0 + 0.5 * x)

    given = kernel(given, spec)

    def slow_by_mean(body, v, start, params):
        dt, linear, angular = params.dt, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)
        if body.drag_linear > 0.0 or body.drag_quadratic > 0.0:
            x, y, z = start.vx + v.vx, start.vy + v.vy, start.vz + v.vz
            speed = 0.5 * sqrt(x * x + y * y + z * z)
            x = dt * body.inv_m * (body.drag_linear + body.drag_quadratic * speed)
            linear = Vec3(
                given(start.vx, v.vx, x), given(start.vy, v.vy, x), given(start.vz, v.vz, x)
            )
        if turns:
            if body.drag_angular > 0.0:
                bx, by, bz = to_body(body, start.wx, start.wy, start.wz)
                x, y, z = to_body(body, v.wx, v.wy, v.wz)
                c = body.drag_angular * dt
                x, y, z = to_world(
                    body,
                    given(bx, x, c * body.inv_ix),
                    given(by, y, c * body.inv_iy),
                    given(bz, z, c * body.inv_iz),
                )
                angular = Vec3(x, y, z)
        return linear, angular

    return kernel(slow_by_mean, spec)


def _make_difference(spec: Spec) -> Any:
    """Return `kernel(body, v, w) -> speed` by which a body's drag differs from what it noted."""
    turns = step_terms(spec).turns

    def difference(body, v, w):
        speed = length(minus(v, Vec3(body.slowed_vx, body.slowed_vy, body.slowed_vz)))
        if turns:
            if body.drag_angular > 0.0:
                noted = Vec3(body.slowed_wx, body.slowed_wy, body.slowed_wz)
                speed += body.bound * length(minus(w, noted))
        return speed

    return kernel(difference, spec)


def make_differs_midway(spec: Spec) -> Any:
    """Return `kernel(state, count, params) -> whether` contacts change what drag does to a body."""
    turns, slow_by_mean = step_terms(spec).turns, make_slow_by_mean(spec)
    difference = _make_difference(spec)

    def differs_midway(state, count, params):
        for i in range(state.motion.shape[0]):
            body, v = state.bodies[i], state.velocities[i]
            if body.inv_m == 0.0 or body.shape == PLANE:
                continue
            squared = v.vx * v.vx + v.vy * v.vy + v.vz * v.vz
            if turns:
                spin = v.wx * v.wx + v.wy * v.wy + v.wz * v.wz
                squared += body.bound * body.bound * spin
            if squared > STILL * STILL:
                linear, angular = slow_by_mean(body, v, state.motion[i], params)
                if difference(body, linear, angular) > SAME:
                    return True
        return False

    return kernel(differs_midway, spec)


def make_note_middle(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, lead, midway, params) -> change`: drag by both ends.

    velocities: at the end of the step, as far as they are known; lead: at its start, spins turned
    to the middle, where bodies stand. change: the largest since the last pass [m/s]; rows that
    slide do not miss it.
    """
    turns, slow_by_mean = step_terms(spec).turns, make_slow_by_mean(spec)
    difference = _make_difference(spec)

    def note_middle(bodies, velocities, lead, midway, params):
        largest = 0.0
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if midway and body.inv_m > 0.0:
                v, w = slow_by_mean(body, velocities[i], lead[i], params)
                largest = max(largest, difference(body, v, w))
                body.slowed_vx, body.slowed_vy, body.slowed_vz = v.x, v.y, v.z
                if turns:
                    body.slowed_wx, body.slowed_wy, body.slowed_wz = w.x, w.y, w.z
        return largest

    return kernel(note_middle, spec)


def make_act_midway(spec: Spec) -> Any:
    """Return `kernel(bodies, poses, velocities)`: velocities get what drag does by both ends.

    In place of what it did by the start; poses: bodies there.
    """
    turns = step_terms(spec).turns

    def act_midway(bodies, poses, velocities):
        for i in range(bodies.shape[0]):
            body, start, v = bodies[i], poses[i], velocities[i]
            v.vx += body.slowed_vx - start.slowed_vx
            v.vy += body.slowed_vy - start.slowed_vy
            v.vz += body.slowed_vz - start.slowed_vz
            if turns:
                v.wx += body.slowed_wx - start.slowed_wx
                v.wy += body.slowed_wy - start.slowed_wy
                v.wz += body.slowed_wz - start.slowed_wz

    return kernel(act_midway, spec)
