"""A body and a direction enter; the point of the body's core farthest that way leaves.

A shape is its core, grown by a radius: a sphere is a point, a capsule a segment, grown by theirs;
boxes, cylinders and hulls are their own cores. Points are relative to the body's centre, along the
world's axes; the origin's distance costs no digits.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel, once
from ...records import BOX, CAPSULE, CYLINDER, SPHERE
from ...rotation import to_body, to_world


def shapes_in(spec) -> frozenset[str]:
    """Return the names of the shapes that the pairs of `spec` hold."""
    from .. import SHAPE_PAIRS

    return frozenset(shape for pair in spec.shape_pairs for shape in SHAPE_PAIRS[pair].shapes)


@once
def make_radius(spec):
    """Return `kernel(body) -> radius of the ball that the core is grown by` [m]."""

    def radius(body):
        if body.shape == SPHERE or body.shape == CAPSULE:
            return body.hx
        return 0.0

    return kernel(radius, spec)


@once
def make_support(spec):
    """Return `kernel(body, dx, dy, dz, tables) -> (x, y, z)`; d of any length but zero.

    tables: those of the hulls (hull_geometry.py).
    """
    shapes = shapes_in(spec)
    boxes, capsules = "box" in shapes, "capsule" in shapes
    cylinders, hulls = "cylinder" in shapes, "hull" in shapes

    def support(body, dx, dy, dz, tables):
        if boxes:
            if body.shape == BOX:
                lx, ly, lz = to_body(body, dx, dy, dz)
                return to_world(
                    body,
                    body.hx if lx >= 0.0 else -body.hx,
                    body.hy if ly >= 0.0 else -body.hy,
                    body.hz if lz >= 0.0 else -body.hz,
                )
        if capsules:
            if body.shape == CAPSULE:
                along = body.r02 * dx + body.r12 * dy + body.r22 * dz
                s = body.hz if along >= 0.0 else -body.hz
                return body.r02 * s, body.r12 * s, body.r22 * s
        if cylinders:
            if body.shape == CYLINDER:
                lx, ly, lz = to_body(body, dx, dy, dz)
                across = sqrt(lx * lx + ly * ly)
                # Straight along the axis every point of the cap is extreme: its centre.
                share = body.hx / across if across > 1e-150 else 0.0
                return to_world(body, share * lx, share * ly, body.hz if lz >= 0.0 else -body.hz)
        if hulls:
            if body.shape != SPHERE:
                lx, ly, lz = to_body(body, dx, dy, dz)
                vertices = tables.vertices
                first = tables.vertex_start[body.hull]
                last = tables.vertex_start[body.hull + 1]
                best, farthest = first, -1e300
                for k in range(first, last):
                    reach = lx * vertices[k, 0] + ly * vertices[k, 1] + lz * vertices[k, 2]
                    if reach > farthest:
                        best, farthest = k, reach
                return to_world(body, vertices[best, 0], vertices[best, 1], vertices[best, 2])
        return 0.0, 0.0, 0.0

    return kernel(support, spec)
