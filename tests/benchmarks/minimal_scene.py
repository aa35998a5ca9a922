"""Balls over planes enter, as arrays; where they are some steps later leaves. Written by hand.

What the pruned engine is measured against: the same discrete mechanics as `minimal_drop` for any
number of balls and planes in arrays, in one function. It has what a kernel for just this scene
needs and nothing of an engine: no plan, no shapes, no warm start, no residual, no log, no check of
what it computes. `minimal_drop` keeps its one ball in registers, which no kernel can that finds its
bodies in memory.
"""

from __future__ import annotations

import numba
import numpy as np

BALL = np.dtype(
    [(name, "f8") for name in ("x", "y", "z", "vx", "vy", "vz", "inv_m", "radius")], align=True
)
PLANE = np.dtype([(name, "f8") for name in ("nx", "ny", "nz", "offset")], align=True)
CONTACT = np.dtype(
    [
        *[(name, "i8") for name in ("ball", "plane")],
        *[(name, "f8") for name in ("phi", "target", "impulse", "push", "correction", "moved")],
    ],
    align=True,
)


@numba.njit(error_model="numpy", nogil=True)
def minimal_scene(balls, planes, contacts, p, steps):
    """Advance balls (records BALL) above planes (records PLANE); p: a `minimal_drop.Drop`."""
    dt, touching = p.dt, p.touching
    for _ in range(steps):
        count = 0
        for i in range(balls.shape[0]):
            ball = balls[i]
            for k in range(planes.shape[0]):
                plane = planes[k]
                phi = plane.nx * ball.x + plane.ny * ball.y + plane.nz * ball.z
                phi = phi - plane.offset - ball.radius
                if phi <= touching:
                    contact = contacts[count]
                    contact.ball, contact.plane, contact.phi = i, k, phi
                    count += 1
            ball.vz -= p.g * dt
        if count > 0:
            for c in range(count):
                contact = contacts[c]
                ball, plane = balls[contact.ball], planes[contact.plane]
                v_n = plane.nx * ball.vx + plane.ny * ball.vy + plane.nz * ball.vz
                contact.target, contact.impulse = 0.0, 0.0
                if -v_n > p.restitution_speed:
                    contact.target += p.restitution * v_n
                excess = -contact.phi - p.slop
                if excess > 0.0:
                    contact.target -= p.gain / dt * excess
            for _ in range(p.sweeps):
                for c in range(count):
                    contact = contacts[c]
                    ball, plane = balls[contact.ball], planes[contact.plane]
                    v_n = plane.nx * ball.vx + plane.ny * ball.vy + plane.nz * ball.vz
                    new = max(0.0, contact.impulse - (v_n + contact.target) / ball.inv_m)
                    change = (new - contact.impulse) * ball.inv_m
                    contact.impulse = new
                    ball.vx += plane.nx * change
                    ball.vy += plane.ny * change
                    ball.vz += plane.nz * change
        for i in range(balls.shape[0]):
            ball = balls[i]
            ball.x += ball.vx * dt
            ball.y += ball.vy * dt
            ball.z += ball.vz * dt
        if count > 0:
            for c in range(count):
                contact = contacts[c]
                ball, plane = balls[contact.ball], planes[contact.plane]
                v_n = plane.nx * ball.vx + plane.ny * ball.vy + plane.nz * ball.vz
                contact.correction = p.projection * max(-(contact.phi + v_n * dt) - p.slop, 0.0)
                contact.push, contact.moved = 0.0, 0.0
            for _ in range(p.projection_sweeps):
                for c in range(count):
                    contact = contacts[c]
                    ball, plane = balls[contact.ball], planes[contact.plane]
                    lack = contact.correction - contact.moved
                    new = max(contact.push + lack / ball.inv_m, 0.0)
                    change = (new - contact.push) * ball.inv_m
                    contact.push = new
                    contact.moved += change
                    ball.x += plane.nx * change
                    ball.y += plane.ny * change
                    ball.z += plane.nz * change


def start(height: float, drop) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return one ball at rest with its centre at `height` [m], the floor, and room for contacts."""
    balls, planes, contacts = np.zeros(1, BALL), np.zeros(1, PLANE), np.zeros(1, CONTACT)
    balls["z"], balls["inv_m"], balls["radius"] = height, 1.0 / drop.mass, drop.radius
    planes["nz"] = 1.0
    return balls, planes, contacts
