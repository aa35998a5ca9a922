"""A polygon or a line clipped to a convex outline, both seen along n.

I. E. Sutherland and G. W. Hodgman, Reentrant polygon clipping, Comm. ACM 17 (1974) 32: one side of
the outline after the other cuts off what lies beyond it. A cylinder's cap clips as a disc, which
seen along n is an ellipse.

Coordinates: u, v across n, w along n, in the fields x, y, z of POINT rows. `rows` has two halves, a
polygon each; every cut reads one half and writes the other. Corners are named by the lines that
meet in them: the subject's lines 0.. and the outline's OTHER + 0..; line k leads from corner k.

Room: for each run of corners beyond it, a cut adds two corners and takes at least one away. A
convex polygon has one such run, so that a cut adds one corner at most. By round-off, corners near
the line of a cut may stand on either side of it. They are at the two ends of the piece of that line
in the polygon, since no three corners of a face are in line (geometry/convex_hull leaves out the
middle one, a million times coarser than round-off); at each end two at most, since two lines of the
subject and two of the outline, the cut among them, are all that meet in a point. That makes two
runs at most: a polygon of n corners has n + 2 m after m cuts at most, which half of `rows` has room
for (collide/scratch). `cut_straight` stops where that half is full only to keep to its memory.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ...compile import inner
from ...records import TOUCHING
from ...vectors import dot, minus, plus_scaled, position
from ..records import DISC, UNBOUNDED, normal_of
from .point import copy_point, place

OTHER = 1 << 8


class HalfPlane(NamedTuple):
    """What of the plane u, v is kept: u x + v y <= limit, (u, v) a unit vector."""

    u: float
    v: float
    limit: float


class TiltedDisc(NamedTuple):
    """A disc seen along n: its centre, the rise of its plane per u and per v, its radius."""

    u: float
    v: float
    rise_u: float
    rise_v: float
    radius: float


@inner
def blend(p, q, share, target, in_line, out_line):
    """Write the point p + share (q - p)."""
    place(target, plus_scaled(p, share, minus(q, p)), 0.0, 0)
    target.in_line, target.out_line = in_line, out_line


@inner
def beyond(side, p):
    """How far a point lies beyond the edge of a half plane [m]."""
    return side.u * p.x + side.v * p.y - side.limit


@inner
def cut_straight(rows, start, count, side, line):
    """Keep the part of a polygon in a half plane, in the other half of `rows`; the new count.

    start: first row of the polygon; line: name of the side.
    """
    kept, room = 0, rows.shape[0] // 2
    target = room - start
    for k in range(count):
        if kept + 2 > room:
            break
        p, q = rows[start + k], rows[start + (k + 1) % count]
        p_over, q_over = beyond(side, p), beyond(side, q)
        if p_over <= 0.0:
            copy_point(p, rows[target + kept])
            kept += 1
        if (p_over <= 0.0) != (q_over <= 0.0):
            r = rows[target + kept]
            share = p_over / (p_over - q_over)
            if p_over <= 0.0:
                blend(p, q, share, r, p.out_line, line)
            else:
                blend(p, q, share, r, line, p.out_line)
            kept += 1
    return kept


@inner
def disc_roots(p, q, disc):
    """Where the line p q, seen along n, enters and leaves a tilted disc: shares of p q.

    Without a crossing the first exceeds the second.
    """
    x, y = p.x - disc.u, p.y - disc.v
    z = disc.rise_u * x + disc.rise_v * y
    dx, dy = q.x - p.x, q.y - p.y
    dz = disc.rise_u * dx + disc.rise_v * dy
    a = dx * dx + dy * dy + dz * dz
    b = x * dx + y * dy + z * dz
    c = x * x + y * y + z * z - disc.radius * disc.radius
    under = b * b - a * c
    if under <= 0.0 or a == 0.0:
        return (-UNBOUNDED, UNBOUNDED) if a == 0.0 and c <= 0.0 else (2.0, -1.0)
    root = sqrt(under)
    return (-b - root) / a, (-b + root) / a


@inner
def cut_round(rows, count, disc):
    """Keep the part of the polygon in the first half inside a disc, arcs as their chords."""
    kept, target = 0, rows.shape[0] // 2
    for k in range(count):
        p, q = rows[k], rows[(k + 1) % count]
        enters, leaves = disc_roots(p, q, disc)
        if enters >= leaves or leaves <= 0.0 or enters >= 1.0:
            continue
        if enters <= 0.0:
            copy_point(p, rows[target + kept])
        else:
            blend(p, q, enters, rows[target + kept], OTHER, p.out_line)
        kept += 1
        if leaves < 1.0:
            blend(p, q, leaves, rows[target + kept], p.out_line, OTHER)
            kept += 1
    return kept


@inner
def side_of(corners, count, k, turn, frame):
    """Return the half plane inside a loop's side k seen along n; turn: 1, or -1 to turn right."""
    p = position(corners[k])
    d = minus(position(corners[(k + 1) % count]), p)
    du, dv = dot(frame.t1, d), dot(frame.t2, d)
    scale = turn / sqrt(du * du + dv * dv)
    u, v = dv * scale, -du * scale
    # A corner on a side but for round-off is inside, or aligned faces would rename their points.
    return HalfPlane(u, v, u * dot(frame.t1, p) + v * dot(frame.t2, p) + TOUCHING)


@inner
def slope_of(plane, frame):
    """Rise of w on a plane per u and per v."""
    n = normal_of(plane)
    nu, nv, nw = dot(n, frame.t1), dot(n, frame.t2), dot(n, frame.n)
    return -nu / nw, -nv / nw


@inner
def disc_of(outline, frame):
    """Return a cap as it is seen along n, larger by TOUCHING."""
    plane = outline.plane[0]
    centre = position(plane)
    rise_u, rise_v = slope_of(plane, frame)
    return TiltedDisc(
        dot(frame.t1, centre), dot(frame.t2, centre), rise_u, rise_v, plane.radius + TOUCHING
    )


@inner
def cut_polygon(rows, count, outline, feature, turn, frame):
    """Cut the polygon in the first `count` rows to an outline; returns (first row, count)."""
    half = rows.shape[0] // 2
    if feature.kind == DISC:
        return half, cut_round(rows, count, disc_of(outline, frame))
    start = 0
    for k in range(feature.corners):
        side = side_of(outline.corners, feature.corners, k, turn, frame)
        count = cut_straight(rows, start, count, side, OTHER + k)
        start = half - start
    return start, count


@inner
def cut_line(rows, outline, feature, turn, frame):
    """Cut the line in rows 0 and 1 to an outline; its ends go to the second half; the count."""
    half = rows.shape[0] // 2
    p, q = rows[0], rows[1]
    low, high, low_line, high_line = 0.0, 1.0, 0, 1
    if feature.kind == DISC:
        enters, leaves = disc_roots(p, q, disc_of(outline, frame))
        if enters > low:
            low, low_line = enters, OTHER
        if leaves < high:
            high, high_line = leaves, OTHER + 1
    else:
        for k in range(feature.corners):
            side = side_of(outline.corners, feature.corners, k, turn, frame)
            p_over, q_over = beyond(side, p), beyond(side, q)
            if p_over > 0.0 and q_over > 0.0:
                return 0
            if p_over > 0.0:
                share = p_over / (p_over - q_over)
                if share > low:
                    low, low_line = share, OTHER + k
            elif q_over > 0.0:
                share = p_over / (p_over - q_over)
                if share < high:
                    high, high_line = share, OTHER + k
    if low > high:
        return 0
    blend(p, q, low, rows[half], low_line, 0)
    blend(p, q, high, rows[half + 1], high_line, 1)
    return 2
