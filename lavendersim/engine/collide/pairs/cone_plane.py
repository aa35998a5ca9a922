"""Manifold of a plane A and a cone B: its base's octagon, or a point of the rim and the apex.

Standing, the base touches by an octagon as a cylinder's cap does; lying, the rim touches by its
lowest point and the apex with it. n is the plane's normal.
The features: 0..7 corners of the octagon, 8 the rim's lowest point, 9 the apex, RIM and above other
points of the rim (pairs/cylinder_plane.py).
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...step_terms import step_terms
from ...vectors import Vec3, dot, from_body, into_body, negative
from ..manifold.features import FACE_COSINE
from ..records import put_position
from ..scratch import CAP_CORNERS
from ..shapes.cone import APEX
from ..shapes.cylinder import NO_LENGTH, put_cap
from .cylinder_plane import DEEP, LEANS, ROUNDER, keep_corners, make_put_rim


def make(spec):
    """Return `kernel(plane, cone, margin, scratch) -> count`; it writes `scratch.manifold`."""

    overlooks, put_rim = step_terms(spec).overlooks, make_put_rim(spec)

    def cone_plane(plane, cone, margin, scratch):
        n, origin = Vec3(plane.hx, plane.hy, plane.hz), Vec3(0.0, 0.0, 0.0)
        height = dot(n, cone) - plane.offset
        down = into_body(cone, negative(n))
        across = sqrt(down.x * down.x + down.y * down.y)
        of_apex, of_rim = APEX * cone.hz * down.z, cone.hx * across - cone.hz * down.z
        if height - max(of_apex, of_rim) > margin:
            return 0
        outline, total, first = scratch.outline_b, CAP_CORNERS, 0
        if down.z <= -FACE_COSINE:
            put_cap(cone, origin, down, outline)
        else:
            total, first = 2, CAP_CORNERS
            # Upright on its apex the rim has no lowest point: any is as low.
            x, y = (down.x / across, down.y / across) if across > NO_LENGTH else (1.0, 0.0)
            lowest = from_body(cone, Vec3(cone.hx * x, cone.hx * y, -cone.hz))
            put_position(outline.corners[0], lowest)
            put_position(outline.corners[1], from_body(cone, Vec3(0.0, 0.0, APEX * cone.hz)))
        kept = keep_corners(cone, (total, first), (n, height), margin, scratch)
        if overlooks:
            if down.z < -LEANS and cone.hx * across * ROUNDER > DEEP:
                kept += put_rim(cone, (down, across, height), n, margin, kept, scratch)
        return kept

    return kernel(cone_plane, spec)
