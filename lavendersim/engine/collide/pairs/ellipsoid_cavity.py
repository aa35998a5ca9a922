"""Manifold of a cavity A and an ellipsoid B: one point, to round-off, by Newton's method.

The point that is farthest from the centre or the axis has its normal along itself:

    q + p(u) = s u        q: the ellipsoid's centre from the cavity's, p(u): its point of normal u

Newton's method across u: (s - K) du = (q + p) - s u, with K = dp/du (shapes/ellipsoid.py); across
the axis of a drum, too. All radii of curvature of the ellipsoid are less than the cavity's, which
configs are checked for: where it touches, s - K is then positive, and the point is the only one.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...vectors import (
    Vec3,
    across,
    cross,
    dot,
    from_body,
    into_body,
    length,
    plus,
    plus_scaled,
    position,
    scaled,
)
from ..manifold.cavity_points import CorePoint, make_axis, make_from_centre, make_put_point
from ..shapes.ellipsoid import point_of_normal, turned_by

NEWTON_STEPS = 64
CONVERGED = 1e-15  # [rad]


@once
def make(spec):
    """Return `kernel(cavity, ellipsoid, margin, scratch) -> count`; writes `scratch.manifold`."""
    axis_of, from_centre = make_axis(spec), make_from_centre(spec)
    put_point = make_put_point(spec)

    def ellipsoid_cavity(cavity, ellipsoid, margin, scratch):
        q, axis = from_centre(cavity, position(ellipsoid)), axis_of(cavity)
        far = length(q)
        if cavity.hx - far - ellipsoid.bound > margin:
            return 0
        drum = dot(axis, axis) > 0.0
        u = Vec3(0.0, 0.0, -1.0)
        if far > 0.0:
            u = scaled(1.0 / far, q)
        elif drum:
            u = across(axis)
            u = scaled(1.0 / length(u), u)
        for _ in range(NEWTON_STEPS):
            local = into_body(ellipsoid, u)
            p, h = point_of_normal(ellipsoid, local)
            out = from_centre(cavity, plus(position(ellipsoid), from_body(ellipsoid, p)))
            s = dot(out, u)
            aside = plus_scaled(out, -s, u)
            # Two directions across u; in a drum one, as the other is its axis.
            e1 = cross(axis, u) if drum else across(u)
            e1 = scaled(1.0 / length(e1), e1)
            e2 = cross(u, e1)
            one, other = into_body(ellipsoid, e1), into_body(ellipsoid, e2)
            k11, k12 = turned_by(ellipsoid, p, h, one, one), turned_by(ellipsoid, p, h, one, other)
            k22 = turned_by(ellipsoid, p, h, other, other)
            g1, g2 = dot(aside, e1), dot(aside, e2)
            if drum:
                d1, d2 = g1 / max(s - k11, k11), 0.0
            else:
                a, b, c = s - k11, -k12, s - k22
                determinant = a * c - b * b
                if a > 0.0 and determinant > 0.0:
                    d1, d2 = (c * g1 - b * g2) / determinant, (a * g2 - b * g1) / determinant
                else:  # far from the wall: along the point itself
                    d1, d2 = g1 / max(s, h), g2 / max(s, h)
            u = plus(u, plus_scaled(scaled(d1, e1), d2, e2))
            u = scaled(1.0 / length(u), u)
            if d1 * d1 + d2 * d2 <= CONVERGED * CONVERGED:
                break
        p, _ = point_of_normal(ellipsoid, into_body(ellipsoid, u))
        at = plus(position(ellipsoid), from_body(ellipsoid, p))
        return put_point(cavity, CorePoint(at, 0.0, 0), margin, scratch.manifold, 0)

    return kernel(ellipsoid_cavity, spec)
