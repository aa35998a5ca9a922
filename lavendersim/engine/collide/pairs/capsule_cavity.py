"""Manifold of a cavity A and a capsule B: up to two points, at the ends of its axis.

The feature of a point is the end: 0 at -z, 1 at +z of the capsule's frame.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...vectors import Vec3, plus_scaled, position
from ..manifold.cavity_points import CorePoint, make_put_point


@once
def make(spec):
    """Return `kernel(cavity, capsule, margin, scratch) -> count`; it writes `scratch.manifold`."""
    put_point = make_put_point(spec)

    def capsule_cavity(cavity, capsule, margin, scratch):
        axis, count = Vec3(capsule.r02, capsule.r12, capsule.r22), 0
        for end in range(2):
            along = capsule.hz if end else -capsule.hz
            p = plus_scaled(position(capsule), along, axis)
            core = CorePoint(p, capsule.hx, end)
            count = put_point(cavity, core, margin, scratch.manifold, count)
        return count

    return kernel(capsule_cavity, spec)
