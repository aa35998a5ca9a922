"""Manifold of a plane A and a sphere B: at most one point, in closed form. n is the plane's normal.

phi = n . x_b - offset - r
"""

from __future__ import annotations

from ...compile import kernel
from ...vectors import Vec3, dot
from ..manifold.point import place, put_manifold_normal


def make(spec):
    """Return `kernel(plane, sphere, margin, scratch) -> count`, which writes `scratch.manifold`."""

    def sphere_plane(plane, sphere, margin, scratch):
        n, r = Vec3(plane.hx, plane.hy, plane.hz), sphere.hx
        phi = dot(n, sphere) - plane.offset - r
        if phi > margin:
            return 0
        put_manifold_normal(scratch.manifold, n)
        reach = r + 0.5 * phi
        p = Vec3(sphere.x - n.x * reach, sphere.y - n.y * reach, sphere.z - n.z * reach)
        place(scratch.manifold.points[0], p, phi, 0)
        return 1

    return kernel(sphere_plane, spec)
