"""A plane A and a box B enter; up to four corners below the plane leave. n is the plane's normal.

The feature of a point is its corner, bit 0, 1, 2 set where the corner lies at +x, +y, +z.

Of a plate, or of a box that comes fast, more than four corners may be within the margin. Then those
of the face that looks down most are kept: each other one lies straight above one of them, as seen
from the box, and stays above it unless the box turns by more than asin(1/sqrt(3)), 35 degrees, in a
step. The four that span most area would be others: an upper corner lies further out.
"""

from __future__ import annotations

from ...compile import inner, kernel
from ...rotation import to_body, to_world
from ..manifold.point import copy_point, place
from ..shape_pair import ShapePair


@inner
def lower_side(bx, by, bz):
    """Return the face that looks against (bx, by, bz): the bit of its axis, its corners' value."""
    if abs(bz) >= abs(bx) and abs(bz) >= abs(by):
        return 4, 0 if bz > 0.0 else 4
    if abs(by) >= abs(bx):
        return 2, 0 if by > 0.0 else 2
    return 1, 0 if bx > 0.0 else 1


@inner
def keep_lower(points, count, bx, by, bz):
    """Keep the corners of the lower face, in their order; returns the new count."""
    bit, value = lower_side(bx, by, bz)
    kept = 0
    for k in range(count):
        if points[k].feature & bit == value:
            copy_point(points[k], points[kept])
            kept += 1
    return kept


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
        if count > 4:
            count = keep_lower(points, count, bx, by, bz)
        return count

    return kernel(box_plane, spec)


PAIR = ShapePair("box_plane", ("plane", "box"), make)
