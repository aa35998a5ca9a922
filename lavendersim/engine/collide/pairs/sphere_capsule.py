"""A capsule A and a sphere B enter; at most one point leaves. n points from A's axis to B's centre.

A centre on the axis has no direction of its own: n is then the capsule's x.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ..manifold.point import place
from ..shape_pair import ShapePair
from .sphere_sphere import NO_DIRECTION


def make(spec):
    """Return `kernel(capsule, sphere, points, normal, scratch, margin) -> count`."""

    def sphere_capsule(capsule, sphere, points, normal, scratch, margin):
        dx, dy, dz = sphere.x - capsule.x, sphere.y - capsule.y, sphere.z - capsule.z
        s = dx * capsule.r02 + dy * capsule.r12 + dz * capsule.r22
        s = min(max(s, -capsule.hz), capsule.hz)
        dx, dy, dz = dx - s * capsule.r02, dy - s * capsule.r12, dz - s * capsule.r22
        squared = dx * dx + dy * dy + dz * dz
        reach = capsule.hx + sphere.hx + margin
        if squared > reach * reach:
            return 0
        distance = sqrt(squared)
        nx, ny, nz = capsule.r00, capsule.r10, capsule.r20
        if distance > NO_DIRECTION:
            nx, ny, nz = dx / distance, dy / distance, dz / distance
        phi = distance - capsule.hx - sphere.hx
        normal[0], normal[1], normal[2] = nx, ny, nz
        middle = capsule.hx + 0.5 * phi
        place(
            points[0],
            capsule.x + s * capsule.r02 + nx * middle,
            capsule.y + s * capsule.r12 + ny * middle,
            capsule.z + s * capsule.r22 + nz * middle,
            phi,
            0,
        )
        return 1

    return kernel(sphere_capsule, spec)


PAIR = ShapePair("sphere_capsule", ("capsule", "sphere"), make, closed_form=True)
