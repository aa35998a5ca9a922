"""Manifold of a plane A and an ellipsoid B: at most one point, in closed form.

n is the plane's normal, p the ellipsoid's point whose normal is -n, from its centre:
    phi = n . x_b - offset - h(n),   p = -R D^2 R^T n / h(n)
"""

from __future__ import annotations

from ...compile import kernel
from ...vectors import Vec3, dot, from_body, into_body, negative
from ..manifold.point import place, put_manifold_normal
from ..shapes.ellipsoid import point_of_normal


def make(spec):
    """Return `kernel(plane, ellipsoid, margin, scratch) -> count`; it writes `scratch.manifold`."""

    def ellipsoid_plane(plane, ellipsoid, margin, scratch):
        n = Vec3(plane.hx, plane.hy, plane.hz)
        height = dot(n, ellipsoid) - plane.offset
        if height - ellipsoid.bound > margin:
            return 0
        lowest, h = point_of_normal(ellipsoid, into_body(ellipsoid, negative(n)))
        phi = height - h
        if phi > margin:
            return 0
        put_manifold_normal(scratch.manifold, n)
        p, half = from_body(ellipsoid, lowest), 0.5 * phi
        middle = Vec3(
            ellipsoid.x + p.x - half * n.x,
            ellipsoid.y + p.y - half * n.y,
            ellipsoid.z + p.z - half * n.z,
        )
        place(scratch.manifold.points[0], middle, phi, 0)
        return 1

    return kernel(ellipsoid_plane, spec)
