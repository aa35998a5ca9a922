"""A box A and a sphere B enter; at most one point leaves. n points from the box to the sphere.

Outside, the nearest point of the box is its centre's coordinates clamped to the box. With the
centre inside, the nearest face pushes it out.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...rotation import to_body, to_world
from ..manifold.point import place
from ..shape_pair import ShapePair
from .sphere_sphere import NO_DIRECTION


def make(spec):
    """Return `kernel(box, sphere, points, normal, scratch, margin) -> count`."""

    def sphere_box(box, sphere, points, normal, scratch, margin):
        cx, cy, cz = to_body(box, sphere.x - box.x, sphere.y - box.y, sphere.z - box.z)
        px = min(max(cx, -box.hx), box.hx)
        py = min(max(cy, -box.hy), box.hy)
        pz = min(max(cz, -box.hz), box.hz)
        dx, dy, dz = cx - px, cy - py, cz - pz
        squared = dx * dx + dy * dy + dz * dz
        r = sphere.hx
        if squared > (r + margin) * (r + margin):
            return 0
        distance = sqrt(squared)
        if distance > NO_DIRECTION:
            mx, my, mz = dx / distance, dy / distance, dz / distance
            phi = distance - r
        else:
            gap_x, gap_y, gap_z = box.hx - abs(cx), box.hy - abs(cy), box.hz - abs(cz)
            mx, my, mz = 0.0, 0.0, 0.0
            if gap_x <= gap_y and gap_x <= gap_z:
                mx = 1.0 if cx >= 0.0 else -1.0
                px, phi = mx * box.hx, -gap_x - r
            elif gap_y <= gap_z:
                my = 1.0 if cy >= 0.0 else -1.0
                py, phi = my * box.hy, -gap_y - r
            else:
                mz = 1.0 if cz >= 0.0 else -1.0
                pz, phi = mz * box.hz, -gap_z - r
        half = 0.5 * phi
        wx, wy, wz = to_world(box, px + mx * half, py + my * half, pz + mz * half)
        nx, ny, nz = to_world(box, mx, my, mz)
        normal[0], normal[1], normal[2] = nx, ny, nz
        place(points[0], box.x + wx, box.y + wy, box.z + wz, phi, 0)
        return 1

    return kernel(sphere_box, spec)


PAIR = ShapePair("sphere_box", ("box", "sphere"), make, closed_form=True)
