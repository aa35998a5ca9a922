"""A plane A and a sphere B enter; at most one point leaves. n is the plane's normal.

phi = n . x_b - offset - r
"""

from __future__ import annotations

from ...compile import kernel
from ..manifold.point import place
from ..shape_pair import ShapePair


def make(spec):
    """Return `kernel(plane, sphere, points, normal, scratch, margin) -> count`."""

    def sphere_plane(plane, sphere, points, normal, scratch, margin):
        nx, ny, nz = plane.hx, plane.hy, plane.hz
        r = sphere.hx
        phi = nx * sphere.x + ny * sphere.y + nz * sphere.z - plane.offset - r
        if phi > margin:
            return 0
        normal[0], normal[1], normal[2] = nx, ny, nz
        reach = r + 0.5 * phi
        place(
            points[0],
            sphere.x - nx * reach,
            sphere.y - ny * reach,
            sphere.z - nz * reach,
            phi,
            0,
        )
        return 1

    return kernel(sphere_plane, spec)


PAIR = ShapePair("sphere_plane", ("plane", "sphere"), make)
