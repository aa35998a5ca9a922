"""A plane A and a box B enter; up to four corners below the plane leave. n is the plane's normal.

The feature of a point is its corner, bit 0, 1, 2 set where the corner lies at +x, +y, +z.
"""

from __future__ import annotations

from ..compile import kernel
from ..rotation import to_body, to_world
from .point import keep_four, place


def make(spec):
    """Return `kernel(plane, box, points, normal, scratch, margin) -> count`."""

    def box_plane(plane, box, points, normal, scratch, margin):
        nx, ny, nz = plane.hx, plane.hy, plane.hz
        height = nx * box.x + ny * box.y + nz * box.z - plane.offset
        bx, by, bz = to_body(box, nx, ny, nz)
        if height > abs(bx) * box.hx + abs(by) * box.hy + abs(bz) * box.hz + margin:
            return 0
        normal[0], normal[1], normal[2] = nx, ny, nz
        count = 0
        for corner in range(8):
            cx = box.hx if corner & 1 else -box.hx
            cy = box.hy if corner & 2 else -box.hy
            cz = box.hz if corner & 4 else -box.hz
            phi = height + bx * cx + by * cy + bz * cz
            if phi <= margin:
                wx, wy, wz = to_world(box, cx, cy, cz)
                place(
                    points[count],
                    box.x + wx - 0.5 * phi * nx,
                    box.y + wy - 0.5 * phi * ny,
                    box.z + wz - 0.5 * phi * nz,
                    phi,
                    corner,
                )
                count += 1
        return keep_four(points, count, nx, ny, nz)

    return kernel(box_plane, spec)
