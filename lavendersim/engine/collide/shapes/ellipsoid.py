"""Ellipsoid of semi-axes hx, hy, hz [m]: a smooth core, grown by a radius. No face and no edge.

    h(n) = |D n|,   p(n) = D^2 n / h,   dp/dn = (D^2 - p p^T) / h        D = diag(hx, hy, hz)
p(n) is the point whose normal is the unit vector n; the eigenvalues of dp/dn across n are the radii
of curvature there. None is less than (shortest)^2 / longest, so that the surface is that of a
smooth convex core grown by a share of this radius: bodies that overlap by less have cores apart,
whose nearest points GJK finds.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel
from ...vectors import Vec3, from_body, into_body

# Of the least radius of curvature, what the core is grown by [-].
GROWN = 0.5


@inner
def curvature_radius(body):
    """Return the least radius of curvature of its surface [m]."""
    least = min(body.hx, min(body.hy, body.hz))
    return least * least / max(body.hx, max(body.hy, body.hz))


@inner
def point_of_normal(body, d):
    """Return (p, h) of a direction of any length in the body's frame."""
    x, y, z = body.hx * d.x, body.hy * d.y, body.hz * d.z
    h = sqrt(x * x + y * y + z * z)
    return Vec3(body.hx * x / h, body.hy * y / h, body.hz * z / h), h


@inner
def turned_by(body, p, h, u, v):
    """Return u . dp/dn v at the point p of height h; all vectors in the body's frame [m]."""
    stretched = body.hx * body.hx * u.x * v.x + body.hy * body.hy * u.y * v.y
    stretched += body.hz * body.hz * u.z * v.z
    along = (p.x * u.x + p.y * u.y + p.z * u.z) * (p.x * v.x + p.y * v.y + p.z * v.z)
    return (stretched - along) / h


def make_radius(spec):
    """Return `kernel(body) -> radius that the core is grown by` [m]."""

    def ellipsoid_radius(body):
        return GROWN * curvature_radius(body)

    return kernel(ellipsoid_radius, spec)


def make_support(spec):
    """Return `kernel(body, direction, hulls) -> Vec3`: p(n) - r n, of the core."""

    def ellipsoid_support(body, direction, hulls):
        d = into_body(body, direction)
        p, _ = point_of_normal(body, d)
        back = GROWN * curvature_radius(body) / sqrt(d.x * d.x + d.y * d.y + d.z * d.z)
        return from_body(body, Vec3(p.x - back * d.x, p.y - back * d.y, p.z - back * d.z))

    return kernel(ellipsoid_support, spec)


def make_half_extents(spec):
    """Return `kernel(body) -> Vec3`: h along the world's axes."""

    def ellipsoid_half_extents(body):
        a, b, c = body.hx, body.hy, body.hz
        return Vec3(
            sqrt((a * body.r00) ** 2 + (b * body.r01) ** 2 + (c * body.r02) ** 2),
            sqrt((a * body.r10) ** 2 + (b * body.r11) ** 2 + (c * body.r12) ** 2),
            sqrt((a * body.r20) ** 2 + (b * body.r21) ** 2 + (c * body.r22) ** 2),
        )

    return kernel(ellipsoid_half_extents, spec)
