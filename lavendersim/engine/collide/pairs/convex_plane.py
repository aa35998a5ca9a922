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
from ..shapes import make_feature, make_radius, make_support

CORNER_BITS = 8  # of a name, for the corner within the feature
LOWEST = 1 << 60  # the name of the lowest point


@inner
def put_above(row, body, p, n, below, phi, name):
    """Write the point half way between the plane and the surface of a body.

    p: of its core, from its centre; below: how far below p the surface lies [m].
    """
    down = below + 0.5 * phi
    middle = Vec3(
        body.x + p.x - down * n.x,
        body.y + p.y - down * n.y,
        body.z + p.z - down * n.z,
    )
    place(row, middle, phi, name)


def make(spec):
    """Return `kernel(plane, body, margin, scratch) -> count`, which writes `scratch.manifold`."""
    support, feature, radius = make_support(spec), make_feature(spec), make_radius(spec)

    def convex_plane(plane, body, margin, scratch):
        n, hulls = Vec3(plane.hx, plane.hy, plane.hz), scratch.hulls
        below = radius(body)
        height = dot(n, body) - plane.offset - below
        if height + below - body.bound > margin:
            return 0
        lowest = support(body, negative(n), hulls)
        phi = height + dot(n, lowest)
        if phi > margin:
            return 0
        count, least, rows = 0, 1e300, scratch.polygon
        found = feature(body, Vec3(0.0, 0.0, 0.0), negative(n), hulls, scratch.outline_b)
        for k in range(found.corners):
            p = position(scratch.outline_b.corners[k])
            above = height + dot(n, p)
            if above <= margin:
                least = min(least, above)
                put_above(rows[count], body, p, n, below, above, (found.name << CORNER_BITS) | k)
                count += 1
        if least > phi + TOUCHING:
            put_above(rows[count], body, lowest, n, below, phi, LOWEST)
            count += 1
        return write_manifold(scratch.manifold, rows, count, n)

    return kernel(convex_plane, spec)
