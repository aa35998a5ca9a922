"""Manifold of a cavity A and a sphere B: at most one point, in closed form (`cavity_points`)."""

from __future__ import annotations

from ...compile import kernel, once
from ...vectors import position
from ..manifold.cavity_points import CorePoint, make_put_point


@once
def make(spec):
    """Return `kernel(cavity, sphere, margin, scratch) -> count`; it writes `scratch.manifold`."""
    put_point = make_put_point(spec)

    def sphere_cavity(cavity, sphere, margin, scratch):
        core = CorePoint(position(sphere), sphere.hx, 0)
        return put_point(cavity, core, margin, scratch.manifold, 0)

    return kernel(sphere_cavity, spec)
