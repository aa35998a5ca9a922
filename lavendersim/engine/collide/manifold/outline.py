"""A polygon or a line and an outline enter, seen along n; the part inside of the outline leaves.

Coordinates: u, v across n, w along n; `frame` holds t1, t2, n. The outline is a loop of corners or,
of a cylinder's cap, a disc, which seen along n is an ellipse. Corners are named by the lines that
meet in them: the subject's lines 0.. and the outline's OTHER + 0..; line k leads from corner k.

A convex polygon gains at most one corner with each side that cuts it, which is what `rows` has room
for. Corners of a side that lies along the cut may fall on alternate sides of it by round-off and
gain more: beyond the room they are left out.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner
from ...records import TOUCHING
from .features import DISC
from .point import copy_point, place

OTHER = 1 << 8


@inner
def blend(p, q, share, target, in_line, out_line):
    """Write the point p + share (q - p)."""
    place(
        target,
        p.x + share * (q.x - p.x),
        p.y + share * (q.y - p.y),
        p.z + share * (q.z - p.z),
        0.0,
        0,
    )
    target.in_line, target.out_line = in_line, out_line


@inner
def cut_straight(rows, start, count, target, gu, gv, limit, line):
    """Keep the part of a polygon with g . (u, v) <= limit; returns the new count."""
    kept, room = 0, rows.shape[0] // 2
    for k in range(count):
        if kept + 2 > room:
            break
        p, q = rows[start + k], rows[start + (k + 1) % count]
        p_over = gu * p.x + gv * p.y - limit
        q_over = gu * q.x + gv * q.y - limit
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
def disc_roots(p, q, cu, cv, gu, gv, radius):
    """Where the line p q, seen along n, enters and leaves a tilted disc: shares of p q.

    w rises by g . (u, v) on the disc's plane. Without a crossing the first exceeds the second.
    """
    x, y = p.x - cu, p.y - cv
    z = gu * x + gv * y
    dx, dy = q.x - p.x, q.y - p.y
    dz = gu * dx + gv * dy
    a = dx * dx + dy * dy + dz * dz
    b = x * dx + y * dy + z * dz
    c = x * x + y * y + z * z - radius * radius
    under = b * b - a * c
    if under <= 0.0 or a == 0.0:
        return (-1e300, 1e300) if a == 0.0 and c <= 0.0 else (2.0, -1.0)
    root = sqrt(under)
    return (-b - root) / a, (-b + root) / a


@inner
def cut_round(rows, start, count, target, cu, cv, gu, gv, radius):
    """Keep the part of a polygon inside a disc, arcs as their chords; returns the new count."""
    kept = 0
    for k in range(count):
        p, q = rows[start + k], rows[start + (k + 1) % count]
        enters, leaves = disc_roots(p, q, cu, cv, gu, gv, radius)
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
def side_of(loop, count, k, turn, frame):
    """Outward unit vector of a loop's side k seen along n, and its limit: (gu, gv, limit)."""
    j = (k + 1) % count
    px, py, pz = loop[k, 0], loop[k, 1], loop[k, 2]
    dx, dy, dz = loop[j, 0] - px, loop[j, 1] - py, loop[j, 2] - pz
    du = frame[0] * dx + frame[1] * dy + frame[2] * dz
    dv = frame[3] * dx + frame[4] * dy + frame[5] * dz
    scale = turn / sqrt(du * du + dv * dv)
    gu, gv = dv * scale, -du * scale
    pu = frame[0] * px + frame[1] * py + frame[2] * pz
    pv = frame[3] * px + frame[4] * py + frame[5] * pz
    # A corner on a side but for round-off is inside, or aligned faces would rename their points.
    return gu, gv, gu * pu + gv * pv + TOUCHING


@inner
def slope_of(plane, frame):
    """Rise of w on a plane per u and per v."""
    nu = plane[0] * frame[0] + plane[1] * frame[1] + plane[2] * frame[2]
    nv = plane[0] * frame[3] + plane[1] * frame[4] + plane[2] * frame[5]
    nw = plane[0] * frame[6] + plane[1] * frame[7] + plane[2] * frame[8]
    return -nu / nw, -nv / nw


@inner
def cut_polygon(rows, half, count, loop, other_count, plane, other_kind, turn, frame):
    """Cut the polygon in rows 0.. to the other's outline; returns (first row, count)."""
    cu = frame[0] * plane[3] + frame[1] * plane[4] + frame[2] * plane[5]
    cv = frame[3] * plane[3] + frame[4] * plane[4] + frame[5] * plane[5]
    gu, gv = slope_of(plane, frame)
    if other_kind == DISC:
        return half, cut_round(rows, 0, count, half, cu, cv, gu, gv, plane[6] + TOUCHING)
    start = 0
    for k in range(other_count):
        su, sv, limit = side_of(loop, other_count, k, turn, frame)
        count = cut_straight(rows, start, count, half - start, su, sv, limit, OTHER + k)
        start = half - start
    return start, count


@inner
def cut_line(rows, half, loop, other_count, plane, other_kind, turn, frame):
    """Cut the line in rows 0 and 1 to the other's outline; its ends go to `half`; the count."""
    p, q = rows[0], rows[1]
    low, high, low_line, high_line = 0.0, 1.0, 0, 1
    if other_kind == DISC:
        cu = frame[0] * plane[3] + frame[1] * plane[4] + frame[2] * plane[5]
        cv = frame[3] * plane[3] + frame[4] * plane[4] + frame[5] * plane[5]
        gu, gv = slope_of(plane, frame)
        enters, leaves = disc_roots(p, q, cu, cv, gu, gv, plane[6] + TOUCHING)
        if enters > low:
            low, low_line = enters, OTHER
        if leaves < high:
            high, high_line = leaves, OTHER + 1
    else:
        for k in range(other_count):
            gu, gv, limit = side_of(loop, other_count, k, turn, frame)
            p_over = gu * p.x + gv * p.y - limit
            q_over = gu * q.x + gv * q.y - limit
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
