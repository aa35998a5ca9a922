"""Manifold of a cavity A and a cylinder B: points of its two rims.

A rim is m + r (cos t e1 + sin t e2); q = m from the cavity's centre or axis. In a bowl its farthest
point lies along q, and with it touch three more, at quarter turns: a disc that lies stands on four.
In a drum a rim is seen along the axis as an ellipse, with e1 across both axes:

    f(t) = (q1 + r cos t)^2 + (q2 + r c sin t)^2         c: cosine between the two axes

Its local maxima, at most two, touch. From each of LOOKS directions that has none farther beside it
Newton's method goes to f' = 0.
The features: RIM times the end (0 at -z, 1 at +z), and the point of the rim, in the order of t.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

from ...compile import inner, kernel, once
from ...records import BOWL
from ...vectors import Vec3, cross, dot, length, plus_scaled, position, scaled
from ..manifold.cavity_points import CorePoint, make_axis, make_from_centre, make_put_point

RIM = 16
QUARTERS = 4
LOOKS = 16
NEWTON_STEPS = 20
CONVERGED = 1e-15  # [rad]
# Sine between the axes, or distance in radii, from which directions follow from them [-].
DISTINCT = 1e-9


class Rim(NamedTuple):
    """A circle, by its centre, world frame, its radius [m] and unit vectors across its axis."""

    centre: Vec3
    r: float
    e1: Vec3
    e2: Vec3
    feature: int  # the name of its first point


@inner
def point_of(rim, t):
    """Return the point at an angle from e1."""
    return plus_scaled(plus_scaled(rim.centre, rim.r * cos(t), rim.e1), rim.r * sin(t), rim.e2)


@once
def make_put_lowest(spec):
    """Return `kernel(drum, rim, margin, manifold, count) -> count`; e1 is across its axis, too."""
    axis_of, from_centre = make_axis(spec), make_from_centre(spec)
    put_point = make_put_point(spec)

    def squared(q1, q2, r, c, t):
        x, y = q1 + r * cos(t), q2 + r * c * sin(t)
        return x * x + y * y

    squared = kernel(squared, spec)

    def put_lowest(drum, rim, margin, manifold, count):
        axis, q = axis_of(drum), from_centre(drum, rim.centre)
        r, e1, e2 = rim.r, rim.e1, rim.e2
        e = plus_scaled(e2, -dot(e2, axis), axis)
        c = length(e)
        q1 = dot(q, e1)
        q2 = dot(q, e) / c if c > 0.0 else 0.0
        stride, found = 2.0 * pi / LOOKS, 0
        for k in range(LOOKS):
            here = squared(q1, q2, r, c, k * stride)
            before = squared(q1, q2, r, c, (k - 1) * stride)
            if not (here >= squared(q1, q2, r, c, (k + 1) * stride) and here > before):
                continue
            t = k * stride
            for _ in range(NEWTON_STEPS):
                x, y = q1 + r * cos(t), q2 + r * c * sin(t)
                slope = -x * sin(t) + y * c * cos(t)
                bend = -x * cos(t) - y * c * sin(t) + r * (sin(t) ** 2 + (c * cos(t)) ** 2)
                if not bend < 0.0:
                    break
                change = min(max(-slope / bend, -stride), stride)
                t += change
                if abs(change) <= CONVERGED:
                    break
            core = CorePoint(point_of(rim, t), 0.0, rim.feature + found)
            count = put_point(drum, core, margin, manifold, count)
            found += 1
        return count

    return kernel(put_lowest, spec)


@once
def make_put_rim(spec):
    """Return `kernel(cavity, body, end, margin, manifold, count) -> count`.

    end: how far the rim, of radius hx, is from the body's centre along its z [m], and the name of
    its first point.
    """
    axis_of, from_centre = make_axis(spec), make_from_centre(spec)
    put_point, put_lowest = make_put_point(spec), make_put_lowest(spec)

    def put_rim(cavity, body, end, margin, manifold, count):
        along, first = end
        own, r = Vec3(body.r02, body.r12, body.r22), body.hx
        centre = plus_scaled(position(body), along, own)
        e1 = Vec3(body.r00, body.r10, body.r20)
        if cavity.shape == BOWL:
            q = from_centre(cavity, centre)
            q = plus_scaled(q, -dot(q, own), own)
            if length(q) > DISTINCT * r:
                e1 = scaled(1.0 / length(q), q)
            rim = Rim(centre, r, e1, cross(own, e1), first)
            for k in range(QUARTERS):
                core = CorePoint(point_of(rim, 0.5 * pi * k), 0.0, rim.feature + k)
                count = put_point(cavity, core, margin, manifold, count)
        else:
            # Where the axes are parallel the rim is a circle: its farthest point is along q.
            aside = cross(own, axis_of(cavity))
            if length(aside) > DISTINCT:
                e1 = scaled(1.0 / length(aside), aside)
            rim = Rim(centre, r, e1, cross(own, e1), first)
            count = put_lowest(cavity, rim, margin, manifold, count)
        return count

    return kernel(put_rim, spec)


@once
def make(spec):
    """Return `kernel(cavity, cylinder, margin, scratch) -> count`; it writes `scratch.manifold`."""
    put_rim = make_put_rim(spec)

    def cylinder_cavity(cavity, cylinder, margin, scratch):
        count = 0
        for end in range(2):
            along = cylinder.hz if end else -cylinder.hz
            count = put_rim(cavity, cylinder, (along, RIM * end), margin, scratch.manifold, count)
        return count

    return kernel(cylinder_cavity, spec)
