"""Manifold of a cavity A and a convex hull B: its corners that are near the wall, all of them.

The feature of a point is its corner, counted in its hull.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...vectors import from_body, plus, position, vector_at
from ..manifold.cavity_points import CorePoint, make_put_point


@once
def make(spec):
    """Return `kernel(cavity, hull, margin, scratch) -> count`, which writes `scratch.manifold`."""
    put_point = make_put_point(spec)

    def hull_cavity(cavity, hull, margin, scratch):
        hulls, count = scratch.hulls, 0
        first, last = hulls.vertex_start[hull.hull], hulls.vertex_start[hull.hull + 1]
        for v in range(first, last):
            p = plus(position(hull), from_body(hull, vector_at(hulls.vertices, v)))
            core = CorePoint(p, 0.0, v - first)
            count = put_point(cavity, core, margin, scratch.manifold, count)
        return count

    return kernel(hull_cavity, spec)
