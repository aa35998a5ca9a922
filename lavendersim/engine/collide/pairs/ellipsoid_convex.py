"""Manifold of any convex body A but planes and an ellipsoid B: one point, to round-off.

GJK says near which normal they are nearest, EPA and the ascent behind it where they overlap by more
than the radii of their cores; Newton's method does the rest (`convex.smooth_normal`). What is
strictly convex touches in one point, whose name never changes.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...vectors import dot, from_body, into_body, minus, negative, plus_scaled, position
from ..convex.epa import make_epa
from ..convex.gjk import FARTHER, OVERLAPPING, make_gjk
from ..convex.separation import CLEAR, CLEARANCE, make_ascend
from ..convex.smooth_normal import make_smooth_normal
from ..manifold.point import place, put_manifold_normal
from ..records import UNBOUNDED, normal_of
from ..shape_kernels import make_radius
from ..shapes.ellipsoid import point_of_normal


@once
def make(spec):
    """Return `kernel(a, ellipsoid, margin, scratch) -> count`, which writes `scratch.manifold`."""
    gjk, epa, ascend = make_gjk(spec), make_epa(spec), make_ascend(spec)
    smooth_normal, radius = make_smooth_normal(spec), make_radius(spec)

    def ellipsoid_convex(a, b, margin, scratch):
        offset = minus(position(b), position(a))
        reach = a.bound + b.bound + margin
        if dot(offset, offset) > reach * reach:
            return 0
        grown = radius(a) + radius(b)
        status, count = gjk(a, b, offset, margin + grown, scratch)
        if status == FARTHER:
            return 0
        found = scratch.separation[0]
        if status == OVERLAPPING:
            epa(a, b, offset, count, True, scratch)
            ascend(a, b, offset, scratch)
            # The vertices that are nearest once B is clear of A.
            clear = CLEAR * max(-found.distance, 0.0) + CLEARANCE * (a.bound + b.bound)
            start = normal_of(found)
            status, count = gjk(a, b, plus_scaled(offset, clear, start), UNBOUNDED, scratch)
            if status == OVERLAPPING:
                count = 0
        else:
            start = normal_of(found)
        best = smooth_normal(a, b, offset, start, count, scratch)
        n, phi = best.normal, best.separation - grown
        if phi > margin:
            return 0
        p, _ = point_of_normal(b, into_body(b, negative(n)))
        surface = plus_scaled(position(b), 1.0, from_body(b, p))
        put_manifold_normal(scratch.manifold, n)
        place(scratch.manifold.points[0], plus_scaled(surface, -0.5 * phi, n), phi, 0)
        return 1

    return kernel(ellipsoid_convex, spec)
