"""Contact patch: the overlap, seen along the normal, of a face, cap or line of A and one of B.

Coordinates: u, v across n, w along n, origin at A's centre. The subject (a line, else the smaller
cap, else B's face) is clipped to the other's outline, and each corner of what is left is a contact
point whose separation is the height of B's surface there less that of A's.

A point is named by the two features and by the lines that meet in it (polygon_clip.py).
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner
from ...records import TOUCHING
from ...vectors import Vec3, across, cross, dot, position, scaled
from ..records import DISC, FACE_LOOP, LINE, POINT, Frame
from .point import copy_point, place
from .polygon_clip import OTHER, blend, cut_line, cut_polygon, slope_of

# Names: 9 bits for each of the two lines that meet, 20 for each feature.
LINE_BITS, FEATURE_BITS = 9, 20
# Both lines of a point where two lines cross; overlapping ones have ends 0, 1, OTHER, OTHER + 1.
CROSS = 2
# Lines that cross at less than this angle [rad] touch along their overlap, not in one point.
PARALLEL = 2e-3


@inner
def frame_along(n):
    """Return a right-handed frame t1, t2, n; t1 is across the smallest component of n."""
    t = across(n)
    t1 = scaled(1.0 / sqrt(dot(t, t)), t)
    return Frame(t1, cross(n, t1), n)


@inner
def load(outline, count, frame, rows):
    """Write a loop's corners as u, v, w."""
    for k in range(count):
        p = position(outline.corners[k])
        place(rows[k], Vec3(dot(frame.t1, p), dot(frame.t2, p), dot(frame.n, p)), 0.0, 0)
        rows[k].in_line, rows[k].out_line = (k + count - 1) % count, k


@inner
def cross_lines(rows):
    """Where two lines cross, or the ends of their overlap when nearly parallel; returns the count.

    The lines lead from row 0 to 1 and from 2 to 3; the rows of the second half are written, with
    A's height in z and B's in phi.
    """
    half = rows.shape[0] // 2
    p, q, r, s = rows[0], rows[1], rows[2], rows[3]
    du, dv = q.x - p.x, q.y - p.y
    eu, ev = s.x - r.x, s.y - r.y
    d, e = du * du + dv * dv, eu * eu + ev * ev
    turn = du * ev - dv * eu
    if turn * turn > PARALLEL * PARALLEL * d * e:
        along_d = ((r.x - p.x) * ev - (r.y - p.y) * eu) / turn
        along_e = ((r.x - p.x) * dv - (r.y - p.y) * du) / turn
        if not (0.0 <= along_d <= 1.0 and 0.0 <= along_e <= 1.0):
            return 0
        blend(p, q, along_d, rows[half], CROSS, CROSS)
        rows[half].phi = r.z + along_e * (s.z - r.z)
        return 1
    at_r = (du * (r.x - p.x) + dv * (r.y - p.y)) / d
    at_s = (du * (s.x - p.x) + dv * (s.y - p.y)) / d
    low, high, low_line, high_line = 0.0, 1.0, 0, 1
    first, last = min(at_r, at_s), max(at_r, at_s)
    # Ends that coincide but for round-off are A's, or aligned lines would rename their points.
    aligned = TOUCHING / sqrt(d)
    if first > low + aligned:
        low, low_line = first, OTHER + (0 if at_r <= at_s else 1)
    if last < high - aligned:
        high, high_line = last, OTHER + (1 if at_r <= at_s else 0)
    if low >= high:
        return 0
    for end in range(2):
        share = high if end else low
        target = rows[half + end]
        blend(p, q, share, target, high_line if end else low_line, end)
        other = (eu * (target.x - r.x) + ev * (target.y - r.y)) / e
        aside_u, aside_v = r.x + other * eu - target.x, r.y + other * ev - target.y
        if aside_u * aside_u + aside_v * aside_v > PARALLEL * PARALLEL * min(d, e):
            return 0  # they pass by each other: these lines are not what touches
        target.x += 0.5 * aside_u
        target.y += 0.5 * aside_v
        target.phi = r.z + other * (s.z - r.z)
    return 2


@inner
def clip_to_other(a, b, frame, scratch):
    """Clip the subject to the other feature; returns (first row of `scratch.polygon`, count).

    In the rows written z is A's height and phi B's. a, b: the `Feature` of each body.
    """
    rows = scratch.polygon
    b_is_subject = a.kind != LINE
    if a.kind == DISC:
        smaller = scratch.outline_a.plane[0].radius < scratch.outline_b.plane[0].radius
        if b.kind == FACE_LOOP or (b.kind == DISC and smaller):
            b_is_subject = False
    if b_is_subject:
        subject, of_subject = b, scratch.outline_b
        other, of_other = a, scratch.outline_a
        turn = 1.0
    else:
        subject, of_subject = a, scratch.outline_a
        other, of_other = b, scratch.outline_b
        turn = -1.0  # B's loop turns right seen along n
    load(of_subject, subject.corners, frame, rows)
    if subject.kind == LINE:
        start, count = rows.shape[0] // 2, cut_line(rows, of_other, other, turn, frame)
    else:
        start, count = cut_polygon(rows, subject.corners, of_other, other, turn, frame)
    plane = of_other.plane[0]
    rise_u, rise_v = slope_of(plane, frame)
    p = position(plane)
    pu, pv, pw = dot(frame.t1, p), dot(frame.t2, p), dot(frame.n, p)
    for k in range(start, start + count):
        height = pw + rise_u * (rows[k].x - pu) + rise_v * (rows[k].y - pv)
        if b_is_subject:
            rows[k].phi, rows[k].z = rows[k].z, height
        else:
            rows[k].phi = height
    return start, count


@inner
def contact_patch(a, b, radius_a, radius_b, frame, scratch):
    """Write the corners of the overlap; returns (first row of `scratch.polygon`, count).

    a, b: the `Feature` of each body, its corners in the outlines of `scratch`. In the rows written
    x, y, z are u, v, w half way between the surfaces.
    """
    rows = scratch.polygon
    if a.kind == POINT or b.kind == POINT:
        return 0, 0
    base = (a.name << (FEATURE_BITS + 2 * LINE_BITS)) | (b.name << (2 * LINE_BITS))
    if a.kind == LINE and b.kind == LINE:
        load(scratch.outline_b, 2, frame, rows)
        copy_point(rows[0], rows[2])
        copy_point(rows[1], rows[3])
        load(scratch.outline_a, 2, frame, rows)
        start, count = rows.shape[0] // 2, cross_lines(rows)
    else:
        start, count = clip_to_other(a, b, frame, scratch)
    for k in range(start, start + count):
        r = rows[k]
        low, high = r.z + radius_a, r.phi - radius_b
        r.phi = high - low
        r.z = 0.5 * (low + high)
        r.feature = base | (r.in_line << LINE_BITS) | r.out_line
    return start, count
