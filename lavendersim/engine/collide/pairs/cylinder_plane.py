"""Manifold of a plane A and a cylinder B: up to four points of its rims. n is the plane's normal.

Standing, the lower cap touches by an octagon (shapes/cylinder.py), whose first corner is where the
cylinder would tip to; lying, each rim touches by its lowest point.
The features: 0..7 corners of the octagon, 8 and 9 the lowest points of the rims at -z and +z.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...vectors import Vec3, dot, from_body, into_body, negative, position
from ..manifold.features import FACE_COSINE
from ..manifold.point import place, write_manifold
from ..records import put_position
from ..scratch import CAP_CORNERS
from ..shape_pair import ShapePair
from ..shapes.cylinder import put_cap


def make(spec):
    """Return `kernel(plane, cylinder, margin, scratch) -> count`; it writes `scratch.manifold`."""

    def cylinder_plane(plane, cylinder, margin, scratch):
        n, origin = Vec3(plane.hx, plane.hy, plane.hz), Vec3(0.0, 0.0, 0.0)
        height = dot(n, cylinder) - plane.offset
        down = into_body(cylinder, negative(n))
        across = sqrt(down.x * down.x + down.y * down.y)
        if height - cylinder.hx * across - cylinder.hz * abs(down.z) > margin:
            return 0
        outline, total, first = scratch.outline_b, CAP_CORNERS, 0
        if abs(down.z) >= FACE_COSINE:
            put_cap(cylinder, origin, down, outline)
        else:
            total, first = 2, CAP_CORNERS
            share = cylinder.hx / across
            for end in range(2):
                z = cylinder.hz if end else -cylinder.hz
                lowest = from_body(cylinder, Vec3(share * down.x, share * down.y, z))
                put_position(outline.corners[end], lowest)
        count, rows = 0, scratch.polygon
        for k in range(total):
            p = position(outline.corners[k])
            phi = height + n.x * p.x + n.y * p.y + n.z * p.z
            if phi <= margin:
                half = 0.5 * phi
                middle = Vec3(
                    cylinder.x + p.x - half * n.x,
                    cylinder.y + p.y - half * n.y,
                    cylinder.z + p.z - half * n.z,
                )
                place(rows[count], middle, phi, first + k)
                count += 1
        return write_manifold(scratch.manifold, rows, count, n)

    return kernel(cylinder_plane, spec)


PAIR = ShapePair("cylinder_plane", ("plane", "cylinder"), make)
