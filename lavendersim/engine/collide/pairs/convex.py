"""Manifold of any two convex bodies but planes: for the pairs that have no closed form.

The separation and its normal come from GJK and EPA (`convex.separation`), bettered between lines by
`manifold.line_normal`. The features that face along the normal, laid over each other, give the
points of faces, caps and lines that rest on one another (`manifold.patch`); where they do not meet,
or hold no point as near as the nearest, the witness points themselves are added.
"""

from __future__ import annotations

from typing import Any

from ...compile import inner, kernel, once
from ...records import TOUCHING
from ...vectors import Vec3, dot, minus, negative, position
from ..convex.separation import make_separate
from ..manifold.edge_line import make_edge_along
from ..manifold.line_normal import make_line_normal
from ..manifold.patch import contact_patch, frame_along
from ..manifold.point import place, write_manifold
from ..records import LINE, UNBOUNDED, normal_of
from ..shape_kernels import make_feature, make_radius
from ..shapes import has_curved

# The name of the witness points: apart from all names of `contact_patch`.
NEAREST = 1 << 60


@inner
def put_patch(a, frame, start, total, margin, rows):
    """Put a patch's corners within the margin into the world; returns (count, least separation)."""
    t1, t2, n = frame.t1, frame.t2, frame.n
    count, least = 0, UNBOUNDED
    for k in range(start, start + total):
        row = rows[k]
        if row.phi <= margin:
            least = min(least, row.phi)
            u, v, w = row.x, row.y, row.z
            p = Vec3(
                a.x + u * t1.x + v * t2.x + w * n.x,
                a.y + u * t1.y + v * t2.y + w * n.y,
                a.z + u * t1.z + v * t2.z + w * n.z,
            )
            place(rows[count], p, row.phi, row.feature)
            count += 1
    return count, least


@inner
def between_witnesses(a, found, radius_a, radius_b):
    """Return the point half way between the surfaces where two bodies are nearest."""
    return Vec3(
        a.x + 0.5 * (found.ax + radius_a * found.nx + found.bx - radius_b * found.nx),
        a.y + 0.5 * (found.ay + radius_a * found.ny + found.by - radius_b * found.ny),
        a.z + 0.5 * (found.az + radius_a * found.nz + found.bz - radius_b * found.nz),
    )


@once
def make(spec):
    """Return `kernel(a, b, margin, scratch) -> count`, which writes `scratch.manifold`."""
    separate, feature, radius = make_separate(spec), make_feature(spec), make_radius(spec)
    line_normal, curved = make_line_normal(spec), has_curved(spec)
    edge_along: Any = make_edge_along(spec)
    edges = edge_along is not None

    def convex(a, b, margin, scratch):
        offset = minus(position(b), position(a))
        reach = a.bound + b.bound + margin
        if dot(offset, offset) > reach * reach:
            return 0
        radius_a, radius_b = radius(a), radius(b)
        if not separate(a, b, offset, margin + radius_a + radius_b, scratch):
            return 0
        found, hulls, origin = scratch.separation[0], scratch.hulls, Vec3(0.0, 0.0, 0.0)
        n = normal_of(found)
        of_a = feature(a, origin, n, hulls, scratch.outline_a)
        of_b = feature(b, offset, negative(n), hulls, scratch.outline_b)
        if edges:
            of_a, of_b = edge_along(a, b, offset, of_a, of_b, scratch)
        if curved:
            if of_a.kind == LINE and of_b.kind == LINE:
                line_normal(a, b, offset, scratch)
                n = normal_of(found)
                of_a = feature(a, origin, n, hulls, scratch.outline_a)
                of_b = feature(b, offset, negative(n), hulls, scratch.outline_b)
                if edges:
                    of_a, of_b = edge_along(a, b, offset, of_a, of_b, scratch)
        phi = found.distance - radius_a - radius_b
        if phi > margin:
            return 0
        frame, rows = frame_along(n), scratch.polygon
        start, total = contact_patch(of_a, of_b, radius_a, radius_b, frame, scratch)
        count, least = put_patch(a, frame, start, total, margin, rows)
        if least > phi + TOUCHING:
            place(rows[count], between_witnesses(a, found, radius_a, radius_b), phi, NEAREST)
            count += 1
        return write_manifold(scratch.manifold, rows, count, n)

    return kernel(convex, spec)
