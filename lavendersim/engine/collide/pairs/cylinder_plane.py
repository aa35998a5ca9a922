"""A plane A and a cylinder B enter; up to four points of its rims leave. n is the plane's normal.

Standing, the lower cap touches by an octagon fixed to the cylinder (features.py), one corner of it
moved to the rim's lowest point when it tilts; lying, each rim touches by its lowest point. The
features: 0..7 corners of the octagon, 8 and 9 the lowest points of the rims at -z and +z.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...rotation import to_body
from ..manifold.features import FACE_COSINE, put_cap
from ..manifold.point import keep_four, place
from ..scratch import CAP_CORNERS
from ..shape_pair import ShapePair


def make(spec):
    """Return `kernel(plane, cylinder, points, normal, scratch, margin) -> count`."""

    def cylinder_plane(plane, cylinder, points, normal, scratch, margin):
        nx, ny, nz = plane.hx, plane.hy, plane.hz
        height = nx * cylinder.x + ny * cylinder.y + nz * cylinder.z - plane.offset
        lx, ly, lz = to_body(cylinder, -nx, -ny, -nz)
        across = sqrt(lx * lx + ly * ly)
        if height - cylinder.hx * across - cylinder.hz * abs(lz) > margin:
            return 0
        normal[0], normal[1], normal[2] = nx, ny, nz
        corners = scratch.loop_b
        total, first = CAP_CORNERS, 0
        if abs(lz) >= FACE_COSINE:
            put_cap(cylinder, 0.0, 0.0, 0.0, lx, ly, lz, corners, scratch.plane_b)
        else:
            total, first = 2, CAP_CORNERS
            share = cylinder.hx / across
            for end in range(2):
                z = cylinder.hz if end else -cylinder.hz
                x, y = share * lx, share * ly
                corners[end, 0] = cylinder.r00 * x + cylinder.r01 * y + cylinder.r02 * z
                corners[end, 1] = cylinder.r10 * x + cylinder.r11 * y + cylinder.r12 * z
                corners[end, 2] = cylinder.r20 * x + cylinder.r21 * y + cylinder.r22 * z
        count = 0
        rows = scratch.polygon
        for k in range(total):
            x, y, z = corners[k, 0], corners[k, 1], corners[k, 2]
            phi = height + nx * x + ny * y + nz * z
            if phi <= margin:
                place(
                    rows[count],
                    cylinder.x + x - 0.5 * phi * nx,
                    cylinder.y + y - 0.5 * phi * ny,
                    cylinder.z + z - 0.5 * phi * nz,
                    phi,
                    first + k,
                )
                count += 1
        count = keep_four(rows, count, nx, ny, nz)
        for k in range(count):
            place(points[k], rows[k].x, rows[k].y, rows[k].z, rows[k].phi, rows[k].feature)
        return count

    return kernel(cylinder_plane, spec)


PAIR = ShapePair("cylinder_plane", ("plane", "cylinder"), make)
