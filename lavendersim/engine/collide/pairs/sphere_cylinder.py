"""A cylinder A and a sphere B enter; at most one point leaves. n points from the cylinder to B.

In the cylinder's frame a centre outside is nearest to its coordinates clamped to the axis and the
rim; a centre inside leaves through the nearer of side and cap.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...rotation import to_body, to_world
from ..manifold.point import place
from ..shape_pair import ShapePair
from .sphere_sphere import NO_DIRECTION


def make(spec):
    """Return `kernel(cylinder, sphere, points, normal, scratch, margin) -> count`."""

    def sphere_cylinder(cylinder, sphere, points, normal, scratch, margin):
        dx, dy, dz = sphere.x - cylinder.x, sphere.y - cylinder.y, sphere.z - cylinder.z
        cx, cy, cz = to_body(cylinder, dx, dy, dz)
        across = sqrt(cx * cx + cy * cy)
        # On the axis every way out through the side is as long: x is taken.
        ux, uy = 1.0, 0.0
        if across > NO_DIRECTION:
            ux, uy = cx / across, cy / across
        up = 1.0 if cz >= 0.0 else -1.0
        over_side, over_cap = across - cylinder.hx, abs(cz) - cylinder.hz
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
        nx, ny, nz = to_world(cylinder, side * ux, side * uy, rise)
        normal[0], normal[1], normal[2] = nx, ny, nz
        # From B's centre to its surface, and on by half the separation.
        back = sphere.hx + 0.5 * phi
        place(points[0], sphere.x - back * nx, sphere.y - back * ny, sphere.z - back * nz, phi, 0)
        return 1

    return kernel(sphere_cylinder, spec)


PAIR = ShapePair("sphere_cylinder", ("cylinder", "sphere"), make)
