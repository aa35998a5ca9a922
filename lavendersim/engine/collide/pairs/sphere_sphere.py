"""Two spheres enter; at most one point leaves. n points from the centre of A to that of B.

    phi = |x_b - x_a| - r_a - r_b

Coincident centres have no direction of their own: n is then the world's z.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ..manifold.point import place
from ..shape_pair import ShapePair

# Centres closer than this count as coincident: their squared distance has lost its digits [m].
NO_DIRECTION = 1e-150


def make(spec):
    """Return `kernel(a, b, points, normal, scratch, margin) -> count`."""

    def sphere_sphere(a, b, points, normal, scratch, margin):
        dx, dy, dz = b.x - a.x, b.y - a.y, b.z - a.z
        reach = a.hx + b.hx + margin
        squared = dx * dx + dy * dy + dz * dz
        if squared > reach * reach:
            return 0
        distance = sqrt(squared)
        nx, ny, nz = 0.0, 0.0, 1.0
        if distance > NO_DIRECTION:
            nx, ny, nz = dx / distance, dy / distance, dz / distance
        phi = distance - a.hx - b.hx
        normal[0], normal[1], normal[2] = nx, ny, nz
        middle = a.hx + 0.5 * phi
        place(points[0], a.x + nx * middle, a.y + ny * middle, a.z + nz * middle, phi, 0)
        return 1

    return kernel(sphere_sphere, spec)


PAIR = ShapePair("sphere_sphere", ("sphere", "sphere"), make, closed_form=True)
