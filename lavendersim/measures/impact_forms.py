"""Velocities after one impact of a body with a plane, in closed form (Newton's restitution).

A body flies under gravity g and meets a plane once, with one point of its surface. With the gap
phi, the normal n and r from the centre to the point, it arrives at the t of
    phi + v_n t + g_n t^2/2 = 0,   v = v0 + g t
and leaves with v + J/m, omega + I^-1 (r x J), where (Newton's law)
    J = j n + J_t,   j = -(1 + e) v_n / k_n.
A sphere's normal and tangential impulse do not act on each other's velocity (r is along n), so its
friction is in closed form too: with the slip u and k_t = 1/m + r^2/I, J_t = -u/k_t stops the slip
where |u|/k_t <= mu j (stick), else J_t = -mu j u/|u| (slip; the direction of u does not change).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from lavendersim.cell import CellBody, CellConfig, Plane, Sphere
from lavendersim.cell.mixing import mixed
from lavendersim.geometry.bodies import inverse_inertia, inverse_mass, lowest_point, mass_of, vector
from lavendersim.geometry.shapes import half_space
from lavendersim.measures.closed_forms import clearance, pair_restitution
from lavendersim.measures.interfaces import Floats


class Velocities(NamedTuple):
    """The velocities of a body, in the world frame."""

    velocity: Floats  # (3,) [m/s]
    angular_velocity: Floats  # (3,) [rad/s]


def velocities_after(cell: CellConfig, body: str, plane: str, time: float) -> Velocities | None:
    """Return the velocities of a body at a time [s] after its only impact.

    None where this has no closed form: no plane, a turning or frictional body that is no sphere,
    no impact before that time, or a second one.
    """
    moving, ground = cell.scene.bodies[body], cell.scene.bodies[plane]
    if not isinstance(ground.shape, Plane):
        return None
    gravity, normal = vector(cell.scene.gravity), half_space(ground.shape).normal
    friction = float(mixed(moving.surface, ground.surface).friction)
    if not isinstance(moving.shape, Sphere) and (friction > 0.0 or any(moving.angular_velocity)):
        return None
    pull = float(normal @ gravity)
    start = vector(moving.velocity)
    arrival = _arrival(clearance(moving, ground), float(normal @ start), pull)
    if arrival is None or arrival > time:
        return None
    before = start + gravity * arrival
    impulse, lever = _impulse(moving, ground, before, friction)
    velocity = before + impulse / mass_of(moving)
    turn = vector(moving.angular_velocity) + inverse_inertia(moving) @ np.cross(lever, impulse)
    separation = float(normal @ velocity)
    if pull < 0.0 and time - arrival >= -2.0 * separation / pull:
        return None
    return Velocities(velocity + gravity * (time - arrival), turn)


def _arrival(gap: float, speed: float, pull: float) -> float | None:
    """Return the first t >= 0 with gap + speed t + pull t^2/2 = 0, in a form without cancelling."""
    inner = speed * speed - 2.0 * pull * gap
    if inner < 0.0:
        return None
    root = math.sqrt(inner)
    if speed > 0.0:  # it rises first, and falls back if it is pulled
        return -(speed + root) / pull if pull < 0.0 else None
    if root - speed == 0.0:
        return 0.0 if gap == 0.0 else None
    return 2.0 * gap / (root - speed)


def _impulse(
    moving: CellBody, ground: CellBody, velocity: Floats, friction: float
) -> tuple[Floats, Floats]:
    """Return the impulse on the body [N s] and the lever from its centre [m]."""
    normal = half_space(ground.shape).normal
    lever = lowest_point(moving, normal) - vector(moving.position)
    cross = np.cross(lever, normal)
    inverse = inverse_inertia(moving)
    k_n = inverse_mass(moving) + float(cross @ inverse @ cross)
    at_point = velocity + np.cross(moving.angular_velocity, lever)
    v_n = float(normal @ at_point)
    size = max(0.0, -(1.0 + pair_restitution(moving, ground, -v_n)) * v_n / k_n)
    impulse: Floats = size * normal
    if friction == 0.0:
        return impulse, lever
    slip = at_point - v_n * normal
    speed = math.sqrt(float(slip @ slip))
    k_t = inverse_mass(moving) + float(lever @ lever) * float(inverse[0, 0])
    if speed > 0.0:
        impulse = impulse - min(speed / k_t, friction * size) * slip / speed
    return impulse, lever
