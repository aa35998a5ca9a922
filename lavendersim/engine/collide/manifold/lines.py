"""A cylinder's side and another straight line that touch enter; their exact normal leaves.

              w  /                  crossing lines part soonest along +-(u x w), whatever the radii;
         -------/--- u              parallel ones along what leads across from one axis to the other
               /

GJK and `ascend` find the direction between a round side and a line by ever finer chords, to some
1e-7 rad at best, and to 1e-4 rad where the gap is 1e-8 m. Along the lines the separation has a
kink: there an error of 1e-7 rad is one of 1e-7 half lengths in depth.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel, once
from ...records import BOX, CYLINDER, HULL
from ..convex.separation import FACE_SHARE, make_separation_along

# Sine from which on two lines have a direction across both [-]: it is then right to some 1e-7 rad,
# and a worse one is not taken.
CROSSING = 1e-9


@once
def make_line_normal(spec):
    """Return `kernel(a, b, ox, oy, oz, scratch)`, which may better `scratch.result[:4]`.

    The lines are rows 0 and 1 of `scratch.loop_a` and `scratch.loop_b`. Nothing changes where one
    of the bodies is no cylinder, or where the directions tried separate less than the one found.
    """
    separation_along = make_separation_along(spec)

    def line_normal(a, b, ox, oy, oz, scratch):
        if a.shape != CYLINDER and b.shape != CYLINDER:
            return
        result, p, q = scratch.result, scratch.loop_a, scratch.loop_b
        ux, uy, uz = p[1, 0] - p[0, 0], p[1, 1] - p[0, 1], p[1, 2] - p[0, 2]
        wx, wy, wz = q[1, 0] - q[0, 0], q[1, 1] - q[0, 1], q[1, 2] - q[0, 2]
        uu, ww = ux * ux + uy * uy + uz * uz, wx * wx + wy * wy + wz * wz
        # From axis to axis; an edge is its own.
        dx, dy, dz = ox, oy, oz
        if a.shape == BOX or a.shape == HULL:
            dx, dy, dz = dx - p[0, 0], dy - p[0, 1], dz - p[0, 2]
        if b.shape == BOX or b.shape == HULL:
            dx, dy, dz = dx + q[0, 0] - ox, dy + q[0, 1] - oy, dz + q[0, 2] - oz
        least = result[3] - FACE_SHARE * (a.bound + b.bound)
        for crossing in range(2):
            if crossing:
                x, y, z = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
                if x * x + y * y + z * z <= CROSSING * CROSSING * uu * ww:
                    continue
            else:
                share = (dx * ux + dy * uy + dz * uz) / uu
                x, y, z = dx - share * ux, dy - share * uy, dz - share * uz
            squared = x * x + y * y + z * z
            if squared == 0.0:
                continue
            scale = 1.0 / sqrt(squared)
            if x * result[0] + y * result[1] + z * result[2] < 0.0:
                scale = -scale
            x, y, z = x * scale, y * scale, z * scale
            s = separation_along(a, b, ox, oy, oz, x, y, z, scratch.hulls)
            # As for faces: the second must be better than the first by more than round-off.
            if s > least:
                result[0], result[1], result[2], result[3] = x, y, z, s
                least = s + FACE_SHARE * (a.bound + b.bound)

    return kernel(line_normal, spec)
