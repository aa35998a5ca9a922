"""A force and a torque about the centre of mass, applied for a part of a step: Newton and Euler.

    v += F dt / m,   omega += I^-1 T dt
Both are of the world frame; the inertia is that at the beginning of the part.
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .rotation import inverse_inertia_times
from .spec import Spec
from .step_terms import step_terms


def make_apply_force(spec: Spec) -> Any:
    """Return `kernel(body, velocity, force, torque, dt)`; without rotation the torque is idle."""
    turns = step_terms(spec).turns

    def apply_force(body, velocity, force, torque, dt):
        scale = body.inv_m * dt
        velocity.vx += force.x * scale
        velocity.vy += force.y * scale
        velocity.vz += force.z * scale
        if turns:
            x, y, z = inverse_inertia_times(body, torque.x, torque.y, torque.z)
            velocity.wx += x * dt
            velocity.wy += y * dt
            velocity.wz += z * dt

    return kernel(apply_force, spec)
