"""Manifold of two spheres: at most one point, in closed form. n points from A's centre to B's.

    phi = |x_b - x_a| - r_a - r_b

Coincident centres have no direction of their own: n is then the world's z.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...vectors import Vec3, divided, dot, minus, plus_scaled
from ..manifold.point import place, put_manifold_normal

# Centres closer than this count as coincident: their squared distance has lost its digits [m].
NO_DIRECTION = 1e-150


def make(spec):
    """Return `kernel(a, b, margin, scratch) -> count`, which writes `scratch.manifold`."""

    def sphere_sphere(a, b, margin, scratch):
        d = minus(b, a)
        reach = a.hx + b.hx + margin
        squared = dot(d, d)
        if squared > reach * reach:
            return 0
        distance = sqrt(squared)
        n = Vec3(0.0, 0.0, 1.0)
        if distance > NO_DIRECTION:
            n = divided(d, distance)
        phi = distance - a.hx - b.hx
        put_manifold_normal(scratch.manifold, n)
        place(scratch.manifold.points[0], plus_scaled(a, a.hx + 0.5 * phi, n), phi, 0)
        return 1

    return kernel(sphere_sphere, spec)
