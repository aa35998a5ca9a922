"""The exact normal of two straight lines that touch, of which one is a cylinder's side.

              w  /                  crossing lines part soonest along +-(u x w), whatever the radii;
         -------/--- u              parallel ones along what leads across from one axis to the other
               /

GJK and `ascend` find the direction between a round side and a line by ever finer chords, to some
1e-7 rad at best, and to 1e-4 rad where the gap is 1e-8 m. Along the lines the separation has a
kink: there an error of 1e-7 rad is one of 1e-7 half lengths in depth.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel, once
from ...vectors import cross, dot, minus, plus, position, scaled
from ..convex.separation import FACE_SHARE, make_separation_along
from ..records import normal_of, put_normal
from ..shape_kernels import make_is_curved, make_is_polyhedral

# Sine from which on two lines have a direction across both [-]: it is then right to some 1e-7 rad,
# and a worse one is not taken.
CROSSING = 1e-9


@inner
def direction_of(outline):
    """Vector from the first end of a line to the second."""
    return minus(position(outline.corners[1]), position(outline.corners[0]))


@once
def make_line_normal(spec):
    """Return `kernel(a, b, offset, scratch)`, which may better the normal in `scratch.separation`.

    The lines are the first two corners of the outlines. Nothing changes where neither body is
    curved, or where the directions tried separate less than the one found.
    """
    separation_along = make_separation_along(spec)
    is_curved, is_polyhedral = make_is_curved(spec), make_is_polyhedral(spec)

    def line_normal(a, b, offset, scratch):
        if not is_curved(a) and not is_curved(b):
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
