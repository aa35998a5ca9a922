"""Cone: radius hx of its base, hz below the centre; its apex 3 hz above it, along its z [m].

Its base as a feature is the octagon of a cylinder's cap; its side is a line from the rim to the
apex, whose normal leans by half the cone's angle a: n_z = sin a, tan a = hx / (4 hz). Face 0: the
base.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel
from ...vectors import Vec3, from_body, into_body
from ..manifold.features import FACE_COSINE, LINE_SLOPE, put_corner
from ..records import DISC, LINE, NO_FEATURE, Feature
from ..scratch import CAP_CORNERS
from .cylinder import NO_LENGTH, put_cap

BASE, SIDE = 0, 2
APEX = 3.0  # its distance from the centre, in that of the base [-]


@inner
def slant(body):
    """Return the length of its side [m]."""
    height = (1.0 + APEX) * body.hz
    return sqrt(body.hx * body.hx + height * height)


@inner
def lean(body):
    """Return n_z of the normals of its side: the sine of half its angle [-]."""
    return body.hx / slant(body)


def make_support(spec):
    """Return `kernel(body, direction, hulls) -> Vec3`: the apex or a point of the rim."""

    def cone_support(body, direction, hulls):
        local = into_body(body, direction)
        across = sqrt(local.x * local.x + local.y * local.y)
        if APEX * body.hz * local.z > body.hx * across - body.hz * local.z:
            return from_body(body, Vec3(0.0, 0.0, APEX * body.hz))
        # Straight down every point of the base is extreme: its centre.
        share = body.hx / across if across > NO_LENGTH else 0.0
        return from_body(body, Vec3(share * local.x, share * local.y, -body.hz))

    return kernel(cone_support, spec)


def make_half_extents(spec):
    """Return `kernel(body) -> Vec3`: of the box about the centre that holds the apex and the rim.

    The rim's plane has the axis u: along x it reaches sqrt(1 - u_x^2) of its radius.
    """

    def cone_half_extents(body):
        r, base = body.hx, body.hz
        return Vec3(
            max(
                APEX * base * abs(body.r02),
                abs(body.r02) * base + sqrt(body.r00 * body.r00 + body.r01 * body.r01) * r,
            ),
            max(
                APEX * base * abs(body.r12),
                abs(body.r12) * base + sqrt(body.r10 * body.r10 + body.r11 * body.r11) * r,
            ),
            max(
                APEX * base * abs(body.r22),
                abs(body.r22) * base + sqrt(body.r20 * body.r20 + body.r21 * body.r21) * r,
            ),
        )

    return kernel(cone_half_extents, spec)


def make_face(spec):
    """Return `kernel(body, n, hulls) -> (base, outward normal)`."""

    def cone_face(body, n, hulls):
        return BASE, Vec3(-body.r02, -body.r12, -body.r22)

    return kernel(cone_face, spec)


def make_feature(spec):
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`: the base, the side or a point.

    The side's normal n_z is that of `lean`: a line that n is across, to within LINE_SLOPE.
    """

    def cone_feature(body, centre, n, hulls, outline):
        local = into_body(body, n)
        if local.z <= -FACE_COSINE:
            put_cap(body, centre, local, outline)
            return Feature(DISC, CAP_CORNERS, BASE)
        across = sqrt(local.x * local.x + local.y * local.y)
        height = (1.0 + APEX) * body.hz
        if not abs(height * local.z - body.hx * across) <= LINE_SLOPE * slant(body):
            return NO_FEATURE
        if not across > NO_LENGTH:
            return NO_FEATURE
        share = body.hx / across
        put_corner(body, centre, Vec3(share * local.x, share * local.y, -body.hz), outline, 0)
        put_corner(body, centre, Vec3(0.0, 0.0, APEX * body.hz), outline, 1)
        return Feature(LINE, 2, SIDE)

    return kernel(cone_feature, spec)
