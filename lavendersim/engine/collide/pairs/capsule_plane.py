"""Manifold of a plane A and a capsule B: up to two points, under the ends of its axis.

n is the plane's normal. The feature of a point is the end: 0 at -z, 1 at +z of the capsule's frame.
"""

from __future__ import annotations

from ...compile import kernel
from ...vectors import Vec3, dot
from ..manifold.point import place, put_manifold_normal


def make(spec):
    """Return `kernel(plane, capsule, margin, scratch) -> count`; it writes `scratch.manifold`."""

    def capsule_plane(plane, capsule, margin, scratch):
        n, axis = Vec3(plane.hx, plane.hy, plane.hz), Vec3(capsule.r02, capsule.r12, capsule.r22)
        height = dot(n, capsule) - plane.offset - capsule.hx
        rise = capsule.hz * dot(n, axis)
        if height - abs(rise) > margin:
            return 0
        put_manifold_normal(scratch.manifold, n)
        count = 0
        for end in range(2):
            s = 1.0 if end else -1.0
            phi = height + s * rise
            if phi <= margin:
                along, down = s * capsule.hz, capsule.hx + 0.5 * phi
                p = Vec3(
                    capsule.x + along * axis.x - down * n.x,
                    capsule.y + along * axis.y - down * n.y,
                    capsule.z + along * axis.z - down * n.z,
                )
                place(scratch.manifold.points[count], p, phi, end)
                count += 1
        return count

    return kernel(capsule_plane, spec)
