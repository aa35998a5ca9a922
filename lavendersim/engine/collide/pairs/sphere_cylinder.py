"""Manifold of a cylinder A and a sphere B: at most one point, in closed form. n is from A to B.

In the cylinder's frame a centre outside is nearest to its coordinates clamped to the axis and the
rim; a centre inside leaves through the nearer of side and cap.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...vectors import Vec3, from_body, into_body, minus
from ..manifold.point import put_ball_point
from .sphere_sphere import NO_DIRECTION


def make(spec):
    """Return `kernel(cylinder, sphere, margin, scratch) -> count`; it writes `scratch.manifold`."""

    def sphere_cylinder(cylinder, sphere, margin, scratch):
        c = into_body(cylinder, minus(sphere, cylinder))
        across = sqrt(c.x * c.x + c.y * c.y)
        # On the axis every way out through the side is as long: x is taken.
        ux, uy = 1.0, 0.0
        if across > NO_DIRECTION:
            ux, uy = c.x / across, c.y / across
        up = 1.0 if c.z >= 0.0 else -1.0
        over_side, over_cap = across - cylinder.hx, abs(c.z) - cylinder.hz
        if over_side <= 0.0 and over_cap <= 0.0:
            if over_side >= over_cap:
                distance, side, rise = over_side, 1.0, 0.0
            else:
                distance, side, rise = over_cap, 0.0, up
        else:
            out_side, out_cap = max(over_side, 0.0), max(over_cap, 0.0)
            distance = sqrt(out_side * out_side + out_cap * out_cap)
            side, rise = out_side / distance, up * out_cap / distance
        phi = distance - sphere.hx
        if phi > margin:
            return 0
        n = from_body(cylinder, Vec3(side * ux, side * uy, rise))
        put_ball_point(scratch.manifold, n, sphere, phi)
        return 1

    return kernel(sphere_cylinder, spec)
