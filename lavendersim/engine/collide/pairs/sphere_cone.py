"""Manifold of a cone A and a sphere B: at most one point, in closed form. n is from A to B.

In the half plane through the axis and the centre (rho, z) the cone is a triangle: its side leads
from the rim (r, -b) to the apex (0, 3 b), its base from the rim to the axis. A centre outside is
nearest to one of the two; a centre inside leaves through the nearer.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...vectors import Vec3, from_body, into_body, minus
from ..manifold.point import put_ball_point
from ..shapes.cone import APEX, slant
from .sphere_sphere import NO_DIRECTION


def make(spec):
    """Return `kernel(cone, sphere, margin, scratch) -> count`; it writes `scratch.manifold`."""

    def sphere_cone(cone, sphere, margin, scratch):
        c = into_body(cone, minus(sphere, cone))
        rho = sqrt(c.x * c.x + c.y * c.y)
        # On the axis every way out through the side is as long: x is taken.
        ux, uy = 1.0, 0.0
        if rho > NO_DIRECTION:
            ux, uy = c.x / rho, c.y / rho
        length, height = slant(cone), (1.0 + APEX) * cone.hz
        # Unit vectors: out of the side, and along it from the apex.
        out_rho, out_z = height / length, cone.hx / length
        below = c.z - APEX * cone.hz
        over_side, over_base = rho * out_rho + below * out_z, -cone.hz - c.z
        if over_side <= 0.0 and over_base <= 0.0:
            if over_side >= over_base:
                distance, side, rise = over_side, out_rho, out_z
            else:
                distance, side, rise = over_base, 0.0, -1.0
        else:
            along = min(max(rho * out_z - below * out_rho, 0.0), length)
            at_rho, at_z = along * out_z, APEX * cone.hz - along * out_rho
            side, rise = rho - at_rho, c.z - at_z
            if over_base > 0.0:
                # The base is nearer than the side to all that is below it.
                side, rise = max(rho - cone.hx, 0.0), -over_base
            if over_base <= 0.0 and 0.0 < along < length:
                distance, side, rise = over_side, out_rho, out_z
            else:
                distance = sqrt(side * side + rise * rise)
                side, rise = side / distance, rise / distance
        phi = distance - sphere.hx
        if phi > margin:
            return 0
        n = from_body(cone, Vec3(side * ux, side * uy, rise))
        put_ball_point(scratch.manifold, n, sphere, phi)
        return 1

    return kernel(sphere_cone, spec)
