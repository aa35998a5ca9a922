"""The exact normal of two straight lines that touch, of which one is a side of what is round.

              w  /                  crossing lines part soonest along +-(u x w), whatever the radii;
         -------/--- u              parallel ones along what leads across from one axis to the other
               /

GJK and `ascend` find the direction between a round side and a line by ever finer chords, to some
1e-7 rad at best, and to 1e-4 rad where the gap is 1e-8 m. Along the lines the separation has a
kink: there an error of 1e-7 rad is one of 1e-7 half lengths in depth.

A cone's line, from rim to apex, goes round its axis z with n: n . z = sin a, half its angle. With a
line w beside it n . w = 0, with another cone's axis minus that one's sine.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

from ...compile import inner, kernel, once
from ...records import CONE
from ...vectors import Vec3, cross, dot, length, minus, plus, plus_scaled, position, scaled
from ..convex.separation import FACE_SHARE, make_separation_along
from ..records import normal_of, put_normal
from ..shape_kernels import make_is_curved, make_is_polyhedral
from ..shapes import shapes_in
from ..shapes.cone import lean

# Sine from which on two lines have a direction across both [-]: it is then right to some 1e-7 rad,
# and a worse one is not taken.
CROSSING = 1e-9
# Cosine to the normal found below which a cone's is that of other lines: the witness points would
# not be theirs.
NEARBY = 1.0 - 1e-4


class Leaning(NamedTuple):
    """What normals of a line's surroundings have in common: n . along = cosine."""

    along: Vec3  # unit: of an edge or an axis
    cosine: float


@inner
def leaning_of(body, outline, sign):
    """Return it of A's line, sign 1, or of B's, -1: a cone's side leans by half its angle."""
    if body.shape == CONE:
        return Leaning(Vec3(body.r02, body.r12, body.r22), sign * lean(body))
    u = direction_of(outline)
    return Leaning(scaled(1.0 / length(u), u), 0.0)


@inner
def leaning_normal(one, other, offset, near, which):
    """Return (n, whether there is one), of unit length, with  n . u = c,  n . w = d  near `near`.

    n = x u + y w + t u x w. which: 1 where the lines cross; 0 where they lie along each other,
    t = 0, or where axes are parallel, from one to the other.
    """
    u, w, c, d = one.along, other.along, one.cosine, other.cosine
    k, aside = dot(u, w), cross(u, w)
    squared = dot(aside, aside)
    if squared <= CROSSING * CROSSING:
        out = minus(offset, scaled(dot(offset, u), u))
        far = length(out)
        if which == 1 or far == 0.0:
            return near, False
        return plus_scaled(scaled(c, u), sqrt(1.0 - c * c) / far, out), True
    n = plus_scaled(scaled((c - k * d) / squared, u), (d - k * c) / squared, w)
    reach = dot(n, n)
    if which == 0:
        return scaled(1.0 / sqrt(reach), n) if reach > 0.0 else near, reach > 0.0
    if not reach < 1.0:
        return near, False
    t = sqrt((1.0 - reach) / squared)
    n = plus_scaled(n, t if dot(near, aside) >= 0.0 else -t, aside)
    return scaled(1.0 / length(n), n), True


@inner
def direction_of(outline):
    """Vector from the first end of a line to the second."""
    return minus(position(outline.corners[1]), position(outline.corners[0]))


def _make_leaning_lines(spec, separation_along):
    """Return the same kernel of lines of which one leans against its axis."""

    def leaning_lines(a, b, offset, scratch):
        found, start = scratch.separation[0], normal_of(scratch.separation[0])
        one = leaning_of(a, scratch.outline_a, 1.0)
        other = leaning_of(b, scratch.outline_b, -1.0)
        least = found.distance - FACE_SHARE * (a.bound + b.bound)
        for which in range(2):
            n, some = leaning_normal(one, other, offset, start, which)
            if not some or dot(n, start) < NEARBY:
                continue
            s = separation_along(a, b, offset, n, scratch.hulls)
            if s > least:
                put_normal(found, n)
                found.distance = s
                least = s + FACE_SHARE * (a.bound + b.bound)

    return kernel(leaning_lines, spec)


@once
def make_line_normal(spec):
    """Return `kernel(a, b, offset, scratch)`, which may better the normal in `scratch.separation`.

    The lines are the first two corners of the outlines. Nothing changes where neither body is
    curved, or where the directions tried separate less than the one found.
    """
    separation_along = make_separation_along(spec)
    is_curved, is_polyhedral = make_is_curved(spec), make_is_polyhedral(spec)
    leans = any(shape.kind == CONE for shape in shapes_in(spec))

    leaning_lines: Any = _make_leaning_lines(spec, separation_along) if leans else None

    def line_normal(a, b, offset, scratch):
        if not is_curved(a) and not is_curved(b):
            return
        if leans:
            if a.shape == CONE or b.shape == CONE:
                leaning_lines(a, b, offset, scratch)
                return
        found = scratch.separation[0]
        u, w = direction_of(scratch.outline_a), direction_of(scratch.outline_b)
        uu, ww = dot(u, u), dot(w, w)
        # From axis to axis; an edge is its own.
        d = offset
        if is_polyhedral(a):
            d = minus(d, position(scratch.outline_a.corners[0]))
        if is_polyhedral(b):
            q = position(scratch.outline_b.corners[0])
            d = minus(plus(d, q), offset)
        least = found.distance - FACE_SHARE * (a.bound + b.bound)
        for crossing in range(2):
            if crossing:
                n = cross(u, w)
                if dot(n, n) <= CROSSING * CROSSING * uu * ww:
                    continue
            else:
                n = minus(d, scaled(dot(d, u) / uu, u))
            squared = dot(n, n)
            if squared == 0.0:
                continue
            scale = 1.0 / sqrt(squared)
            if dot(n, normal_of(found)) < 0.0:
                scale = -scale
            n = scaled(scale, n)
            s = separation_along(a, b, offset, n, scratch.hulls)
            # As for faces: the second must be better than the first by more than round-off.
            if s > least:
                put_normal(found, n)
                found.distance = s
                least = s + FACE_SHARE * (a.bound + b.bound)

    return kernel(line_normal, spec)
