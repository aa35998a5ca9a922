"""Manifold of a plane A and a cylinder B: up to four points of its rims. n is the plane's normal.

Standing, the lower cap touches by an octagon (shapes/cylinder.py), whose first corner is where the
cylinder would tip to; lying, each rim touches by its lowest point.
The features: 0..7 corners of the octagon, 8 and 9 the lowest points of the rims at -z and +z, RIM
and above other points of the lower rim.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from ...compile import inner, kernel
from ...step_terms import step_terms
from ...vectors import Vec3, dot, from_body, into_body, negative, position
from ..manifold.features import FACE_COSINE
from ..manifold.point import LEFT_OUT, WHOLE, place, write_manifold
from ..records import put_position
from ..scratch import CAP_CORNERS
from ..shapes.cylinder import put_cap

RIM = 16
# What is lower than the points of the manifold by less is as low [m].
DEEP = 1e-5
# Cosine to the axis above which a cylinder is no roller that lies: its rim may roll over [-].
LEANS = 0.1
# How much lower the rim is than a side of its octagon, in radii times the sine of the tilt [-].
ROUNDER = 1.0 - cos(pi / 8.0)
RIM_POINTS = 16  # a rim's points; every other one is a corner of its octagon


@inner
def halfway(body, p, n, phi):
    """Return the middle between a corner, p from its body's centre, and the plane below it."""
    half = 0.5 * phi
    return Vec3(body.x + p.x - half * n.x, body.y + p.y - half * n.y, body.z + p.z - half * n.z)


@inner
def keep_corners(body, corners, plane, margin, scratch):
    """Write those of the first corners of `outline_b` that are near the plane; return how many.

    corners: how many there are, and what the first is called. plane: its normal, and the height of
    the body's centre above it [m].
    """
    (total, first), (n, height) = corners, plane
    count, rows = 0, scratch.polygon
    for k in range(total):
        p = position(scratch.outline_b.corners[k])
        phi = height + n.x * p.x + n.y * p.y + n.z * p.z
        if phi <= margin:
            place(rows[count], halfway(body, p, n, phi), phi, first + k)
            count += 1
    return write_manifold(scratch.manifold, rows, count, n)


def make_put_rim(spec):
    """Return `kernel(cylinder, lowest, n, margin, kept, scratch) -> kept more`.

    The lower rim between the points that the manifold has, left out of it: none is as low, but a
    disc that rolls on its rim comes to stand on them. lowest: -n in the cylinder's frame, how much
    of it lies across the axis, and the height of the centre [m].
    """

    def put_rim(cylinder, lowest, n, margin, kept, scratch):
        (down, across, height), manifold = lowest, scratch.manifold
        total = kept + manifold.reduction[LEFT_OUT]
        first = 2 if abs(down.z) >= FACE_COSINE else 1
        x, y = cylinder.hx * down.x / across, cylinder.hx * down.y / across
        z = cylinder.hz if down.z >= 0.0 else -cylinder.hz
        put = 0
        for k in range(1, RIM_POINTS, first):
            c, s = cos(2.0 * pi * k / RIM_POINTS), sin(2.0 * pi * k / RIM_POINTS)
            p = from_body(cylinder, Vec3(c * x - s * y, c * y + s * x, z))
            phi = height + n.x * p.x + n.y * p.y + n.z * p.z
            if phi <= margin:
                middle = halfway(cylinder, p, n, phi)
                place(manifold.points[total + put], middle, phi, RIM + k)
                put += 1
        if manifold.reduction[WHOLE] == 1:
            return put
        manifold.reduction[LEFT_OUT] += put
        return 0

    return kernel(put_rim, spec)


def make(spec):
    """Return `kernel(plane, cylinder, margin, scratch) -> count`; it writes `scratch.manifold`."""

    overlooks, put_rim = step_terms(spec).overlooks, make_put_rim(spec)

    def cylinder_plane(plane, cylinder, margin, scratch):
        n, origin = Vec3(plane.hx, plane.hy, plane.hz), Vec3(0.0, 0.0, 0.0)
        height = dot(n, cylinder) - plane.offset
        down = into_body(cylinder, negative(n))
        across = sqrt(down.x * down.x + down.y * down.y)
        if height - cylinder.hx * across - cylinder.hz * abs(down.z) > margin:
            return 0
        outline, total, first = scratch.outline_b, CAP_CORNERS, 0
        if abs(down.z) >= FACE_COSINE:
            put_cap(cylinder, origin, down, outline)
        else:
            total, first = 2, CAP_CORNERS
            share = cylinder.hx / across
            for end in range(2):
                z = cylinder.hz if end else -cylinder.hz
                lowest = from_body(cylinder, Vec3(share * down.x, share * down.y, z))
                put_position(outline.corners[end], lowest)
        kept = keep_corners(cylinder, (total, first), (n, height), margin, scratch)
        if overlooks:
            if abs(down.z) > LEANS and cylinder.hx * across * ROUNDER > DEEP:
                kept += put_rim(cylinder, (down, across, height), n, margin, kept, scratch)
        return kept

    return kernel(cylinder_plane, spec)
