"""Cylinder: radius hx, half length hz along its z [m].

Its cap as a feature is an inscribed octagon, turned to where the body would tip to. Faces: 0 the
lower cap, 1 the upper.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel
from ...vectors import Vec3, from_body, into_body, vector_of
from ..manifold.features import FACE_COSINE, LINE_SLOPE, put_corner
from ..records import DISC, LINE, NO_FEATURE, Feature, put_normal
from ..scratch import CAP_CORNERS

# A cap tilted less than this [rad] stands: the lowest point of its rim lies less than 1e-6 radii
# deeper, and its direction is mostly noise.
LEVEL = 1e-6
# The side of a cylinder, in names of features; its caps are 0 and 1.
SIDE = 2
DIAGONAL = sqrt(0.5)
# What is shorter has a square that is zero, and no direction [-].
NO_LENGTH = 1e-150


@inner
def octagon_corner(k):
    """Cosine and sine of k eighths of a turn."""
    if k & 1:
        return (
            DIAGONAL if k == 1 or k == 7 else -DIAGONAL,
            DIAGONAL if k <= 3 else -DIAGONAL,
        )
    if k & 2:
        return 0.0, 1.0 if k == 2 else -1.0
    return 1.0 if k == 0 else -1.0, 0.0


@inner
def put_cap(body, centre, local, outline):
    """Write the octagon and the disc of the cap that looks along `local`, in the body's frame.

    Its first corner is where the body would tip to: the rim's lowest point when it tilts, else the
    one along gravity, so that it stands as long as a disc does.
    """
    up = 1.0 if local.z >= 0.0 else -1.0
    x, y = local.x, local.y
    across = sqrt(x * x + y * y)
    if not across > LEVEL:
        along = into_body(body, vector_of(outline.pull))
        x, y = along.x, along.y
        across = sqrt(x * x + y * y)
        if not across > LEVEL * abs(along.z):
            x, y, across = 1.0, 0.0, 1.0
    x, y = x / across, y / across
    for k in range(CAP_CORNERS):
        c, s = octagon_corner(k)
        # Seen from below the octagon turns the other way.
        s *= up
        corner = Vec3(body.hx * (x * c - y * s), body.hx * (y * c + x * s), up * body.hz)
        put_corner(body, centre, corner, outline, k)
    plane = outline.plane[0]
    put_normal(plane, Vec3(body.r02 * up, body.r12 * up, body.r22 * up))
    plane.x = centre.x + plane.nx * body.hz
    plane.y = centre.y + plane.ny * body.hz
    plane.z = centre.z + plane.nz * body.hz
    plane.radius = body.hx


def make_support(spec):
    """Return `kernel(body, direction, hulls) -> Vec3`."""

    def cylinder_support(body, direction, hulls):
        local = into_body(body, direction)
        across = sqrt(local.x * local.x + local.y * local.y)
        # Straight along the axis every point of the cap is extreme: its centre.
        share = body.hx / across if across > NO_LENGTH else 0.0
        z = body.hz if local.z >= 0.0 else -body.hz
        return from_body(body, Vec3(share * local.x, share * local.y, z))

    return kernel(cylinder_support, spec)


def make_half_extents(spec):
    """Return `kernel(body) -> Vec3`.

    A disc with axis u reaches sqrt(1 - u_x^2) of its radius along x. By the other two columns: no
    cancellation where u is nearly x.
    """

    def cylinder_half_extents(body):
        return Vec3(
            abs(body.r02) * body.hz + sqrt(body.r00 * body.r00 + body.r01 * body.r01) * body.hx,
            abs(body.r12) * body.hz + sqrt(body.r10 * body.r10 + body.r11 * body.r11) * body.hx,
            abs(body.r22) * body.hz + sqrt(body.r20 * body.r20 + body.r21 * body.r21) * body.hx,
        )

    return kernel(cylinder_half_extents, spec)


def make_face(spec):
    """Return `kernel(body, n, hulls) -> (cap, outward normal)`."""

    def cylinder_face(body, n, hulls):
        along = body.r02 * n.x + body.r12 * n.y + body.r22 * n.z
        s = 1.0 if along >= 0.0 else -1.0
        return 1 if along >= 0.0 else 0, Vec3(body.r02 * s, body.r12 * s, body.r22 * s)

    return kernel(cylinder_face, spec)


def make_feature(spec):
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`: a cap, the side or a point."""

    def cylinder_feature(body, centre, n, hulls, outline):
        local = into_body(body, n)
        if abs(local.z) >= FACE_COSINE:
            put_cap(body, centre, local, outline)
            return Feature(DISC, CAP_CORNERS, 1 if local.z >= 0.0 else 0)
        if abs(local.z) > LINE_SLOPE:
            return NO_FEATURE
        share = body.hx / sqrt(local.x * local.x + local.y * local.y)
        x, y = share * local.x, share * local.y
        put_corner(body, centre, Vec3(x, y, -body.hz), outline, 0)
        put_corner(body, centre, Vec3(x, y, body.hz), outline, 1)
        return Feature(LINE, 2, SIDE)

    return kernel(cylinder_feature, spec)
