"""Manifold of a plane A and a convex hull B: up to four of its corners. n is the plane's normal.

The feature of a point is its corner, counted in its hull. Of many corners within the margin those
of the face that looks down are a subset; keeping four of all spans at least as much.
"""

from __future__ import annotations

from ...compile import kernel
from ...vectors import Vec3, dot, from_body, into_body, vector_at
from ..manifold.point import place, write_manifold


def make(spec):
    """Return `kernel(plane, hull, margin, scratch) -> count`, which writes `scratch.manifold`."""

    def hull_plane(plane, hull, margin, scratch):
        n, hulls = Vec3(plane.hx, plane.hy, plane.hz), scratch.hulls
        height = dot(n, hull) - plane.offset
        if height - hull.bound > margin:
            return 0
        local = into_body(hull, n)
        vertices, rows = hulls.vertices, scratch.polygon
        first, last = hulls.vertex_start[hull.hull], hulls.vertex_start[hull.hull + 1]
        count = 0
        for v in range(first, last):
            corner = vector_at(vertices, v)
            phi = height + local.x * corner.x + local.y * corner.y + local.z * corner.z
            if phi <= margin:
                p, half = from_body(hull, corner), 0.5 * phi
                middle = Vec3(
                    hull.x + p.x - half * n.x,
                    hull.y + p.y - half * n.y,
                    hull.z + p.z - half * n.z,
                )
                place(rows[count], middle, phi, v - first)
                count += 1
        return write_manifold(scratch.manifold, rows, count, n)

    return kernel(hull_plane, spec)
