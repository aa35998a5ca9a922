"""A ball that falls on a floor, in one function written by hand.

What the engine's single-sphere drop is measured against: the same discrete mechanics (gravity,
plane contact, captured restitution, bias, 22 sweeps of one row, projection) in one function, with
no bodies, rows, plan or warm start around it.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np


class Drop(NamedTuple):
    """Coefficients of the drop. SI units."""

    dt: float
    g: float
    mass: float
    radius: float
    restitution: float
    restitution_speed: float  # approach speed above which restitution applies [m/s]
    gain: float
    slop: float
    projection: float
    touching: float  # gap that counts as contact [m]
    sweeps: int
    projection_sweeps: int


@numba.njit(error_model="numpy", nogil=True)
def minimal_drop(state, p, steps):
    """Advance `state` = x y z vx vy vz above the plane z = 0; returns the last impulse [N s]."""
    x, y, z, vx, vy, vz = state
    inv_m = 1.0 / p.mass
    inv_k = 1.0 / inv_m
    last = 0.0
    for _ in range(steps):
        phi = z - p.radius
        touches = phi <= p.touching
        vz -= p.g * p.dt
        correction = 0.0
        if touches:
            target = 0.0
            if -vz > p.restitution_speed:
                target += p.restitution * vz
            excess = -phi - p.slop
            if excess > 0.0:
                target -= p.gain / p.dt * excess
            impulse = 0.0
            for _ in range(p.sweeps):
                new = max(0.0, impulse - (vz + target) * inv_k)
                vz += (new - impulse) * inv_m
                impulse = new
            last = impulse
            excess = -(phi + vz * p.dt) - p.slop
            if excess > 0.0:
                correction = p.projection * excess
        x += vx * p.dt
        y += vy * p.dt
        z += vz * p.dt
        if correction > 0.0:
            push, u = 0.0, 0.0
            for _ in range(p.projection_sweeps):
                new = max(push + (correction - u) * inv_k, 0.0)
                u += (new - push) * inv_m
                push = new
            z += u
    state[0], state[1], state[2] = x, y, z
    state[3], state[4], state[5] = vx, vy, vz
    return last


def start(height: float) -> np.ndarray:
    """Return the state of a ball at rest with its centre at `height` [m]."""
    return np.array([0.0, 0.0, height, 0.0, 0.0, 0.0])
