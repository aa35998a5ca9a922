"""A face, cap or line of A, one of B and the normal n enter; their overlap seen along n leaves.

Coordinates: u, v across n, w along n, origin at A's centre. The subject (a line, else the smaller
cap, else B's face) is cut to the other's outline, and each corner of what is left is a contact
point whose separation is the height of B's surface there less that of A's.

A point is named by the two features and by the lines that meet in it (outline.py).
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner
from ...records import TOUCHING
from .features import DISC, FACE, LINE, POINT
from .outline import OTHER, blend, cut_line, cut_polygon, slope_of
from .point import copy_point, place

# Names: 9 bits for each of the two lines that meet, 20 for each feature.
LINE_BITS, FEATURE_BITS = 9, 20
# Both lines of a point where two lines cross; overlapping ones have ends 0, 1, OTHER, OTHER + 1.
CROSS = 2
# Lines that cross at less than this angle [rad] touch along their overlap, not in one point.
PARALLEL = 2e-3


@inner
def across(nx, ny, nz):
    """Two unit vectors that make a right-handed frame t1, t2, n."""
    if abs(nx) <= abs(ny) and abs(nx) <= abs(nz):
        x, y, z = 0.0, nz, -ny
    elif abs(ny) <= abs(nz):
        x, y, z = -nz, 0.0, nx
    else:
        x, y, z = ny, -nx, 0.0
    scale = 1.0 / sqrt(x * x + y * y + z * z)
    x, y, z = x * scale, y * scale, z * scale
    return x, y, z, ny * z - nz * y, nz * x - nx * z, nx * y - ny * x


@inner
def load(loop, count, frame, rows):
    """Write a loop's corners as u, v, w."""
    for k in range(count):
        x, y, z = loop[k, 0], loop[k, 1], loop[k, 2]
        place(
            rows[k],
            frame[0] * x + frame[1] * y + frame[2] * z,
            frame[3] * x + frame[4] * y + frame[5] * z,
            frame[6] * x + frame[7] * y + frame[8] * z,
            0.0,
            0,
        )
        rows[k].in_line, rows[k].out_line = (k + count - 1) % count, k


@inner
def overlap_lines(rows, half):
    """Where two lines cross, or the ends of their overlap when nearly parallel; returns the count.

    The lines lead from row 0 to 1 and from 2 to 3. In the rows written z is A's height and phi B's.
    """
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
        beside_u, beside_v = r.x + other * eu - target.x, r.y + other * ev - target.y
        if beside_u * beside_u + beside_v * beside_v > PARALLEL * PARALLEL * min(d, e):
            return 0  # they pass beside each other: these lines are not what touches
        target.x += 0.5 * beside_u
        target.y += 0.5 * beside_v
        target.phi = r.z + other * (s.z - r.z)
    return 2


@inner
def overlay(kind_a, count_a, name_a, kind_b, count_b, name_b, radius_a, radius_b, frame, scratch):
    """Write the corners of the overlap; returns (first row of `scratch.polygon`, count).

    frame: t1, t2, n. Rows leave with x, y, z = u, v, w half way between the surfaces.
    """
    rows = scratch.polygon
    half = rows.shape[0] // 2
    if kind_a == POINT or kind_b == POINT:
        return 0, 0
    base = (name_a << (FEATURE_BITS + 2 * LINE_BITS)) | (name_b << (2 * LINE_BITS))
    if kind_a == LINE and kind_b == LINE:
        load(scratch.loop_b, 2, frame, rows)
        copy_point(rows[0], rows[2])
        copy_point(rows[1], rows[3])
        load(scratch.loop_a, 2, frame, rows)
        start, count = half, overlap_lines(rows, half)
    else:
        b_is_subject = kind_a != LINE
        if kind_a == DISC:
            if kind_b == FACE or (kind_b == DISC and scratch.plane_a[6] < scratch.plane_b[6]):
                b_is_subject = False
        if b_is_subject:
            subject, subject_kind, subject_count = scratch.loop_b, kind_b, count_b
            loop, kind, other_count, plane = scratch.loop_a, kind_a, count_a, scratch.plane_a
            turn = 1.0
        else:
            subject, subject_kind, subject_count = scratch.loop_a, kind_a, count_a
            loop, kind, other_count, plane = scratch.loop_b, kind_b, count_b, scratch.plane_b
            turn = -1.0  # B's loop turns right seen along n
        load(subject, subject_count, frame, rows)
        if subject_kind == LINE:
            start, count = half, cut_line(rows, half, loop, other_count, plane, kind, turn, frame)
        else:
            start, count = cut_polygon(
                rows, half, subject_count, loop, other_count, plane, kind, turn, frame
            )
        gu, gv = slope_of(plane, frame)
        pu = frame[0] * plane[3] + frame[1] * plane[4] + frame[2] * plane[5]
        pv = frame[3] * plane[3] + frame[4] * plane[4] + frame[5] * plane[5]
        pw = frame[6] * plane[3] + frame[7] * plane[4] + frame[8] * plane[5]
        for k in range(start, start + count):
            height = pw + gu * (rows[k].x - pu) + gv * (rows[k].y - pv)
            if b_is_subject:
                rows[k].phi, rows[k].z = rows[k].z, height
            else:
                rows[k].phi = height
    for k in range(start, start + count):
        r = rows[k]
        low, high = r.z + radius_a, r.phi - radius_b
        r.phi = high - low
        r.z = 0.5 * (low + high)
        r.feature = base | (r.in_line << LINE_BITS) | r.out_line
    return start, count
