"""A plane A and a capsule B enter; up to two points leave, under the ends of its axis.

The feature of a point is the end: 0 at -z, 1 at +z of the capsule's frame.
"""

from __future__ import annotations

from ...compile import kernel
from ..manifold.point import place
from ..shape_pair import ShapePair


def make(spec):
    """Return `kernel(plane, capsule, points, normal, scratch, margin) -> count`."""

    def capsule_plane(plane, capsule, points, normal, scratch, margin):
        nx, ny, nz = plane.hx, plane.hy, plane.hz
        height = nx * capsule.x + ny * capsule.y + nz * capsule.z - plane.offset - capsule.hx
        rise = capsule.hz * (nx * capsule.r02 + ny * capsule.r12 + nz * capsule.r22)
        if height - abs(rise) > margin:
            return 0
        normal[0], normal[1], normal[2] = nx, ny, nz
        count = 0
        for end in range(2):
            s = 1.0 if end else -1.0
            phi = height + s * rise
            if phi <= margin:
                along, down = s * capsule.hz, capsule.hx + 0.5 * phi
                place(
                    points[count],
                    capsule.x + along * capsule.r02 - down * nx,
                    capsule.y + along * capsule.r12 - down * ny,
                    capsule.z + along * capsule.r22 - down * nz,
                    phi,
                    end,
                )
                count += 1
        return count

    return kernel(capsule_plane, spec)


PAIR = ShapePair("capsule_plane", ("plane", "capsule"), make)
