"""Manifold of a plane A and a box B: up to four corners below the plane. n is the plane's normal.

The feature of a point is its corner, bit 0, 1, 2 set where the corner lies at +x, +y, +z.

Of a plate, or of a box that comes fast, more than four corners may be within the margin. Then those
of the face that looks down most are kept: each other one lies straight above one of them, as seen
from the box, and stays above it unless the box turns by more than asin(1/sqrt(3)), 35 degrees, in a
step. The four that span most area would be others: an upper corner lies further out.
"""

from __future__ import annotations

from ...compile import inner, kernel
from ...vectors import Vec3, dot, from_body, into_body
from ..manifold.point import LEFT_OUT, WHOLE, place, put_manifold_normal, swap_points
from ..shapes.box import corner_of


@inner
def lower_side(n):
    """Return the face that looks against n, in the box's frame: the bit of its axis, its value."""
    if abs(n.z) >= abs(n.x) and abs(n.z) >= abs(n.y):
        return 4, 0 if n.z > 0.0 else 4
    if abs(n.y) >= abs(n.x):
        return 2, 0 if n.y > 0.0 else 2
    return 1, 0 if n.x > 0.0 else 1


@inner
def keep_lower(points, count, n):
    """Put the corners of the lower face first, in their order; n: in the box's frame; how many."""
    bit, value = lower_side(n)
    kept = 0
    for k in range(count):
        if points[k].feature & bit == value:
            if kept < k:
                swap_points(points[k], points[kept])
            kept += 1
    return kept


def make(spec):
    """Return `kernel(plane, box, margin, scratch) -> count`, which writes `scratch.manifold`."""

    def box_plane(plane, box, margin, scratch):
        n, points = Vec3(plane.hx, plane.hy, plane.hz), scratch.manifold.points
        height = dot(n, box) - plane.offset
        local = into_body(box, n)
        reach = abs(local.x) * box.hx + abs(local.y) * box.hy + abs(local.z) * box.hz
        if height > reach + margin:
            return 0
        put_manifold_normal(scratch.manifold, n)
        count = 0
        for corner in range(8):
            c = corner_of(box, corner)
            phi = height + local.x * c.x + local.y * c.y + local.z * c.z
            if phi <= margin:
                p, half = from_body(box, c), 0.5 * phi
                middle = Vec3(
                    box.x + p.x - half * n.x,
                    box.y + p.y - half * n.y,
                    box.z + p.z - half * n.z,
                )
                place(points[count], middle, phi, corner)
                count += 1
        kept = count
        if count > 4 and scratch.manifold.reduction[WHOLE] == 0:
            kept = keep_lower(points, count, local)
        scratch.manifold.reduction[LEFT_OUT] = count - kept
        return kept

    return kernel(box_plane, spec)
