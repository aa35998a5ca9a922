"""A body enters; how far it reaches leaves: the half edges of its box in the world, its next step.

    reach = |v| dt + |omega| R dt + 2 |g| dt^2,   R radius about the centre of mass that holds it

No point of a body goes farther than that in a step: its velocity after the step's forces differs by
|g| dt, and as much again is left for what else changes it. What nothing can push has no share in g.
The narrow phase must not look farther ahead than the sum of two reaches and TOUCHING.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...records import BOX, CAPSULE, CYLINDER
from ...spec import Spec
from ..convex.support import shapes_in


def make_half_extents(spec: Spec):
    """Return `kernel(body) -> (ex, ey, ez)`: half edges of its axis-aligned box in the world [m].

    Boxes, capsules and cylinders get their least box, all others that of their bounding sphere.
    """
    shapes = shapes_in(spec)
    boxes, capsules, cylinders = "box" in shapes, "capsule" in shapes, "cylinder" in shapes

    def half_extents(body):
        bound = body.bound
        if boxes:
            if body.shape == BOX:
                return (
                    abs(body.r00) * body.hx + abs(body.r01) * body.hy + abs(body.r02) * body.hz,
                    abs(body.r10) * body.hx + abs(body.r11) * body.hy + abs(body.r12) * body.hz,
                    abs(body.r20) * body.hx + abs(body.r21) * body.hy + abs(body.r22) * body.hz,
                )
        if capsules:
            if body.shape == CAPSULE:
                return (
                    abs(body.r02) * body.hz + body.hx,
                    abs(body.r12) * body.hz + body.hx,
                    abs(body.r22) * body.hz + body.hx,
                )
        if cylinders:
            if body.shape == CYLINDER:
                # A disc with axis u reaches sqrt(1 - u_x^2) of its radius along x. By the other two
                # columns: no cancellation where u is nearly x.
                return (
                    abs(body.r02) * body.hz
                    + sqrt(body.r00 * body.r00 + body.r01 * body.r01) * body.hx,
                    abs(body.r12) * body.hz
                    + sqrt(body.r10 * body.r10 + body.r11 * body.r11) * body.hx,
                    abs(body.r22) * body.hz
                    + sqrt(body.r20 * body.r20 + body.r21 * body.r21) * body.hx,
                )
        return bound, bound, bound

    return kernel(half_extents, spec)


def make_reach(spec: Spec):
    """Return `kernel(body, velocity, params) -> reach [m]`; a body with parts has its own bound."""
    turns = spec.has("rotation")

    def reach(body, velocity, params):
        vx, vy, vz = velocity.vx, velocity.vy, velocity.vz
        speed = sqrt(vx * vx + vy * vy + vz * vz)
        if turns:
            wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
            speed += sqrt(wx * wx + wy * wy + wz * wz) * body.bound
        far = speed * params.dt
        if body.inv_m > 0.0:
            gx, gy, gz = params.gx, params.gy, params.gz
            far += 2.0 * sqrt(gx * gx + gy * gy + gz * gz) * params.dt * params.dt
        return far

    return kernel(reach, spec)
