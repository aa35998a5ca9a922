"""Manifold of a box A and a sphere B: at most one point, in closed form. n points from A to B.

Outside, the nearest point of the box is its centre's coordinates clamped to the box. With the
centre inside, the nearest face pushes it out.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel
from ...vectors import Vec3, divided, dot, from_body, into_body, minus, plus, plus_scaled
from ..manifold.point import place, put_manifold_normal
from .sphere_sphere import NO_DIRECTION


@inner
def nearest_face(box, c, p):
    """Leave the box from a centre c inside: (point of the nearest face, outward normal, depth).

    p: c clamped to the box.
    """
    gap_x, gap_y, gap_z = box.hx - abs(c.x), box.hy - abs(c.y), box.hz - abs(c.z)
    if gap_x <= gap_y and gap_x <= gap_z:
        m = 1.0 if c.x >= 0.0 else -1.0
        return Vec3(m * box.hx, p.y, p.z), Vec3(m, 0.0, 0.0), gap_x
    if gap_y <= gap_z:
        m = 1.0 if c.y >= 0.0 else -1.0
        return Vec3(p.x, m * box.hy, p.z), Vec3(0.0, m, 0.0), gap_y
    m = 1.0 if c.z >= 0.0 else -1.0
    return Vec3(p.x, p.y, m * box.hz), Vec3(0.0, 0.0, m), gap_z


def make(spec):
    """Return `kernel(box, sphere, margin, scratch) -> count`, which writes `scratch.manifold`."""

    def sphere_box(box, sphere, margin, scratch):
        c = into_body(box, minus(sphere, box))
        p = Vec3(
            min(max(c.x, -box.hx), box.hx),
            min(max(c.y, -box.hy), box.hy),
            min(max(c.z, -box.hz), box.hz),
        )
        d = minus(c, p)
        squared, r = dot(d, d), sphere.hx
        if squared > (r + margin) * (r + margin):
            return 0
        distance = sqrt(squared)
        if distance > NO_DIRECTION:
            m, phi = divided(d, distance), distance - r
        else:
            p, m, depth = nearest_face(box, c, p)
            phi = -depth - r
        put_manifold_normal(scratch.manifold, from_body(box, m))
        middle = from_body(box, plus_scaled(p, 0.5 * phi, m))
        place(scratch.manifold.points[0], plus(box, middle), phi, 0)
        return 1

    return kernel(sphere_box, spec)
