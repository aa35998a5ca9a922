"""Any two convex bodies but a plane enter; up to four points leave. For pairs without closed forms.

The separation and its normal come from `separation.py`, bettered between lines by `lines.py`. The
features that look along the normal, laid over each other, give the points of faces, caps and lines
that rest on one another; where they do not meet, or hold no point as near as the nearest, the
nearest points themselves are added.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...records import TOUCHING
from ..convex.separation import make_separate
from ..convex.support import make_radius, shapes_in
from ..manifold.features import LINE, make_feature
from ..manifold.lines import make_line_normal
from ..manifold.overlay import across, overlay
from ..manifold.point import copy_point, keep_four, place
from ..shape_pair import ShapePair

# The name of the nearest points: apart from all names of `overlay`.
NEAREST = 1 << 60


@once
def make(spec):
    """Return `kernel(a, b, points, normal, scratch, margin) -> count`."""
    separate, feature, radius = make_separate(spec), make_feature(spec), make_radius(spec)
    line_normal, cylinders = make_line_normal(spec), "cylinder" in shapes_in(spec)

    def convex(a, b, points, normal, scratch, margin):
        ox, oy, oz = b.x - a.x, b.y - a.y, b.z - a.z
        reach = a.bound + b.bound + margin
        if ox * ox + oy * oy + oz * oz > reach * reach:
            return 0
        radius_a, radius_b = radius(a), radius(b)
        if not separate(a, b, ox, oy, oz, margin + radius_a + radius_b, scratch):
            return 0
        result, frame, hulls = scratch.result, scratch.frame, scratch.hulls
        loop_a, plane_a = scratch.loop_a, scratch.plane_a
        loop_b, plane_b = scratch.loop_b, scratch.plane_b
        nx, ny, nz = result[0], result[1], result[2]
        kind_a, count_a, name_a = feature(a, 0.0, 0.0, 0.0, nx, ny, nz, hulls, loop_a, plane_a)
        kind_b, count_b, name_b = feature(b, ox, oy, oz, -nx, -ny, -nz, hulls, loop_b, plane_b)
        if cylinders:
            if kind_a == LINE and kind_b == LINE:
                line_normal(a, b, ox, oy, oz, scratch)
                nx, ny, nz = result[0], result[1], result[2]
                kind_a, count_a, name_a = feature(
                    a, 0.0, 0.0, 0.0, nx, ny, nz, hulls, loop_a, plane_a
                )
                kind_b, count_b, name_b = feature(
                    b, ox, oy, oz, -nx, -ny, -nz, hulls, loop_b, plane_b
                )
        phi = result[3] - radius_a - radius_b
        if phi > margin:
            return 0
        normal[0], normal[1], normal[2] = nx, ny, nz
        frame[0], frame[1], frame[2], frame[3], frame[4], frame[5] = across(nx, ny, nz)
        frame[6], frame[7], frame[8] = nx, ny, nz
        start, total = overlay(
            kind_a, count_a, name_a, kind_b, count_b, name_b, radius_a, radius_b, frame, scratch
        )
        rows = scratch.polygon
        count, least = 0, 1e300
        for k in range(start, start + total):
            if rows[k].phi <= margin:
                least = min(least, rows[k].phi)
                u, v, w = rows[k].x, rows[k].y, rows[k].z
                place(
                    rows[count],
                    a.x + u * frame[0] + v * frame[3] + w * nx,
                    a.y + u * frame[1] + v * frame[4] + w * ny,
                    a.z + u * frame[2] + v * frame[5] + w * nz,
                    rows[k].phi,
                    rows[k].feature,
                )
                count += 1
        if least > phi + TOUCHING:
            place(
                rows[count],
                a.x + 0.5 * (result[4] + radius_a * nx + result[7] - radius_b * nx),
                a.y + 0.5 * (result[5] + radius_a * ny + result[8] - radius_b * ny),
                a.z + 0.5 * (result[6] + radius_a * nz + result[9] - radius_b * nz),
                phi,
                NEAREST,
            )
            count += 1
        count = keep_four(rows, count, nx, ny, nz)
        for k in range(count):
            copy_point(rows[k], points[k])
        return count

    return kernel(convex, spec)


CAPSULE_BOX = ShapePair("capsule_box", ("box", "capsule"), make)
CYLINDER_BOX = ShapePair("cylinder_box", ("box", "cylinder"), make)
CAPSULE_CYLINDER = ShapePair("capsule_cylinder", ("cylinder", "capsule"), make)
CYLINDER_CYLINDER = ShapePair("cylinder_cylinder", ("cylinder", "cylinder"), make)
WITH_HULLS = (
    ShapePair("sphere_hull", ("hull", "sphere"), make),
    ShapePair("hull_box", ("box", "hull"), make),
    ShapePair("capsule_hull", ("hull", "capsule"), make),
    ShapePair("cylinder_hull", ("hull", "cylinder"), make),
    ShapePair("hull_hull", ("hull", "hull"), make),
)
