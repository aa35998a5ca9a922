"""Manifold of a plane A and any convex body B, by its support and the feature that looks down.

Points: the corners of that feature within the margin, and the lowest point of the body where none
of them is as low. Their names: the feature's and the corner's; the lowest point has its own. n is
the plane's normal.
"""

from __future__ import annotations

from ...compile import inner, kernel
from ...records import TOUCHING
from ...vectors import Vec3, dot, negative, position
from ..manifold.point import place, write_manifold
from ..records import UNBOUNDED
from ..shape_kernels import make_feature, make_radius, make_support

CORNER_BITS = 8  # of a name, for the corner within the feature
LOWEST = 1 << 60  # the name of the lowest point


@inner
def below(body, p, down, n):
    """Return the point `down` [m] below p, which is relative to the body's centre."""
    return Vec3(
        body.x + p.x - down * n.x,
        body.y + p.y - down * n.y,
        body.z + p.z - down * n.z,
    )


def make(spec):
    """Return `kernel(plane, body, margin, scratch) -> count`, which writes `scratch.manifold`."""
    support, feature, radius = make_support(spec), make_feature(spec), make_radius(spec)

    def convex_plane(plane, body, margin, scratch):
        n, hulls = Vec3(plane.hx, plane.hy, plane.hz), scratch.hulls
        r = radius(body)
        height = dot(n, body) - plane.offset - r
        if height + r - body.bound > margin:
            return 0
        lowest = support(body, negative(n), hulls)
        phi = height + dot(n, lowest)
        if phi > margin:
            return 0
        count, least, rows = 0, UNBOUNDED, scratch.polygon
        found = feature(body, Vec3(0.0, 0.0, 0.0), negative(n), hulls, scratch.outline_b)
        for k in range(found.corners):
            p = position(scratch.outline_b.corners[k])
            above = height + dot(n, p)
            if above <= margin:
                least = min(least, above)
                middle = below(body, p, r + 0.5 * above, n)
                place(rows[count], middle, above, (found.name << CORNER_BITS) | k)
                count += 1
        if least > phi + TOUCHING:
            place(rows[count], below(body, lowest, r + 0.5 * phi, n), phi, LOWEST)
            count += 1
        return write_manifold(scratch.manifold, rows, count, n)

    return kernel(convex_plane, spec)
