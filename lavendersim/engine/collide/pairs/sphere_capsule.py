"""Manifold of a capsule A and a sphere B: at most one point, in closed form.

n points from A's axis to B's centre. A centre on the axis has no direction of its own: n is then
the capsule's x.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...vectors import Vec3, divided, dot, minus
from ..manifold.point import place, put_manifold_normal
from .sphere_sphere import NO_DIRECTION


def make(spec):
    """Return `kernel(capsule, sphere, margin, scratch) -> count`; it writes `scratch.manifold`."""

    def sphere_capsule(capsule, sphere, margin, scratch):
        d, axis = minus(sphere, capsule), Vec3(capsule.r02, capsule.r12, capsule.r22)
        s = min(max(dot(d, axis), -capsule.hz), capsule.hz)
        d = Vec3(d.x - s * axis.x, d.y - s * axis.y, d.z - s * axis.z)
        squared = dot(d, d)
        reach = capsule.hx + sphere.hx + margin
        if squared > reach * reach:
            return 0
        distance = sqrt(squared)
        n = Vec3(capsule.r00, capsule.r10, capsule.r20)
        if distance > NO_DIRECTION:
            n = divided(d, distance)
        phi = distance - capsule.hx - sphere.hx
        put_manifold_normal(scratch.manifold, n)
        middle = capsule.hx + 0.5 * phi
        p = Vec3(
            capsule.x + s * axis.x + n.x * middle,
            capsule.y + s * axis.y + n.y * middle,
            capsule.z + s * axis.z + n.z * middle,
        )
        place(scratch.manifold.points[0], p, phi, 0)
        return 1

    return kernel(sphere_capsule, spec)
