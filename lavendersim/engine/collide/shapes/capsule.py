"""Capsule: a segment of half length hz along its z, grown by the radius hx [m]."""

from __future__ import annotations

from ...compile import kernel
from ...vectors import Vec3
from ..manifold.features import LINE_SLOPE, put_corner
from ..records import LINE, NO_FEATURE, Feature


def make_support(spec):
    """Return `kernel(body, direction, hulls) -> Vec3`."""

    def capsule_support(body, direction, hulls):
        along = body.r02 * direction.x + body.r12 * direction.y + body.r22 * direction.z
        s = body.hz if along >= 0.0 else -body.hz
        return Vec3(body.r02 * s, body.r12 * s, body.r22 * s)

    return kernel(capsule_support, spec)


def make_half_extents(spec):
    """Return `kernel(body) -> Vec3`."""

    def capsule_half_extents(body):
        return Vec3(
            abs(body.r02) * body.hz + body.hx,
            abs(body.r12) * body.hz + body.hx,
            abs(body.r22) * body.hz + body.hx,
        )

    return kernel(capsule_half_extents, spec)


def make_feature(spec):
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`: the axis, or a point."""

    def capsule_feature(body, centre, n, hulls, outline):
        slope = abs(body.r02 * n.x + body.r12 * n.y + body.r22 * n.z)
        if body.hz == 0.0 or slope > LINE_SLOPE:
            return NO_FEATURE
        put_corner(body, centre, Vec3(0.0, 0.0, -body.hz), outline, 0)
        put_corner(body, centre, Vec3(0.0, 0.0, body.hz), outline, 1)
        return Feature(LINE, 2, 0)

    return kernel(capsule_feature, spec)
