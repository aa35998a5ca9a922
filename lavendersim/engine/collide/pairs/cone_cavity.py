"""Manifold of a cavity A and a cone B: its apex, and points of its rim as of a cylinder's.

A convex body's farthest point is one of its extreme points, of which a cone has no others.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...vectors import Vec3, plus_scaled, position
from ..manifold.cavity_points import CorePoint, make_put_point
from ..shapes.cone import APEX
from .cylinder_cavity import RIM, make_put_rim


@once
def make(spec):
    """Return `kernel(cavity, cone, margin, scratch) -> count`; it writes `scratch.manifold`."""
    put_point, put_rim = make_put_point(spec), make_put_rim(spec)

    def cone_cavity(cavity, cone, margin, scratch):
        own = Vec3(cone.r02, cone.r12, cone.r22)
        count = put_rim(cavity, cone, (-cone.hz, 0), margin, scratch.manifold, 0)
        tip = plus_scaled(position(cone), APEX * cone.hz, own)
        return put_point(cavity, CorePoint(tip, 0.0, RIM), margin, scratch.manifold, count)

    return kernel(cone_cavity, spec)
