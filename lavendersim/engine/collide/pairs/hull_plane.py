"""A plane A and a hull B enter; up to four of its corners leave. n is the plane's normal.

The feature of a point is its corner, counted in its hull. Of many corners within the margin those
of the face that looks down are a subset; keeping four of all spans at least as much.
"""

from __future__ import annotations

from ...compile import kernel
from ...rotation import to_body, to_world
from ..manifold.point import keep_four, place
from ..shape_pair import ShapePair


def make(spec):
    """Return `kernel(plane, hull, points, normal, scratch, margin) -> count`."""

    def hull_plane(plane, hull, points, normal, scratch, margin):
        nx, ny, nz = plane.hx, plane.hy, plane.hz
        height = nx * hull.x + ny * hull.y + nz * hull.z - plane.offset
        if height - hull.bound > margin:
            return 0
        normal[0], normal[1], normal[2] = nx, ny, nz
        bx, by, bz = to_body(hull, nx, ny, nz)
        vertices = scratch.hulls.vertices
        first, last = (
            scratch.hulls.vertex_start[hull.hull],
            scratch.hulls.vertex_start[hull.hull + 1],
        )
        rows = scratch.polygon
        count = 0
        for v in range(first, last):
            phi = height + bx * vertices[v, 0] + by * vertices[v, 1] + bz * vertices[v, 2]
            if phi <= margin:
                x, y, z = to_world(hull, vertices[v, 0], vertices[v, 1], vertices[v, 2])
                place(
                    rows[count],
                    hull.x + x - 0.5 * phi * nx,
                    hull.y + y - 0.5 * phi * ny,
                    hull.z + z - 0.5 * phi * nz,
                    phi,
                    v - first,
                )
                count += 1
        count = keep_four(rows, count, nx, ny, nz)
        for k in range(count):
            place(points[k], rows[k].x, rows[k].y, rows[k].z, rows[k].phi, rows[k].feature)
        return count

    return kernel(hull_plane, spec)


PAIR = ShapePair("hull_plane", ("plane", "hull"), make)
