"""A reference face and the other box enter; the incident face, cut to the reference face, leaves.

Sutherland and Hodgman's clipping in coordinates of the reference face: u and v in the face, w along
its outward normal, origin at its centre. A vertex is named by the two lines that meet in it: the
incident face's edges 0..3 and the reference face's sides 4..7. The name stays the same while the
boxes slide, so the contact cache can follow a vertex.

             v        3 ______ 2      lines of the incident face: k leads from vertex k to k + 1
             |         |      |
             +--- u    |______|       sides of the reference face: 4 u-, 5 u+, 6 v-, 7 v+
                      0        1
"""

from __future__ import annotations

from ...compile import inner
from ...records import TOUCHING
from .point import copy_point, place


@inner
def incident_axis(fi, nx, ny, nz):
    """Axis and side of the face of the incident box whose normal opposes n most."""
    axis, steepest = 0, 0.0
    for k in range(3):
        along = fi[k, 0] * nx + fi[k, 1] * ny + fi[k, 2] * nz
        # The margin keeps the choice when two faces oppose n equally.
        if abs(along) > abs(steepest) + 1e-9:
            axis, steepest = k, along
    return axis, (-1.0 if steepest > 0.0 else 1.0)


@inner
def cut(points, start, count, target, axis, side, limit, line):
    """Keep the part of a polygon with side * coordinate <= limit.

    Reads `count` vertices from row `start`, writes from row `target`; returns the new count.
    x, y hold u, v and z holds w.
    """
    kept = 0
    for k in range(count):
        p = points[start + k]
        q = points[start + (k + 1) % count]
        p_over = side * (p.x if axis == 0 else p.y) - limit
        q_over = side * (q.x if axis == 0 else q.y) - limit
        if p_over <= 0.0:
            copy_point(p, points[target + kept])
            kept += 1
        if (p_over <= 0.0) != (q_over <= 0.0):
            share = p_over / (p_over - q_over)
            r = points[target + kept]
            place(
                r,
                p.x + share * (q.x - p.x),
                p.y + share * (q.y - p.y),
                p.z + share * (q.z - p.z),
                0.0,
                0,
            )
            # Leaving the kept side the new vertex ends the edge; entering, it begins the edge.
            if p_over <= 0.0:
                r.in_line, r.out_line = p.out_line, line
            else:
                r.in_line, r.out_line = line, p.out_line
            kept += 1
    return kept


@inner
def clip_incident_face(ref, inc, fr, fi, hr, hi, axis, side, base, points, normal, margin):
    """Write the manifold on the reference face; returns the count (at most 8).

    ref, inc: the boxes; fr, fi: their axes as rows; hr, hi: half edges; axis, side: the reference
    face; base: where its features start. n is the outward normal of that face.
    """
    nx, ny, nz = side * fr[axis, 0], side * fr[axis, 1], side * fr[axis, 2]
    normal[0], normal[1], normal[2] = nx, ny, nz
    iu, iv = (axis + 1) % 3, (axis + 2) % 3
    cx = ref.x + hr[axis] * nx
    cy = ref.y + hr[axis] * ny
    cz = ref.z + hr[axis] * nz
    inc_axis, inc_side = incident_axis(fi, nx, ny, nz)
    ju, jv = (inc_axis + 1) % 3, (inc_axis + 2) % 3
    for k in range(4):
        su = hi[ju] if k == 1 or k == 2 else -hi[ju]
        sv = hi[jv] if k >= 2 else -hi[jv]
        sn = inc_side * hi[inc_axis]
        dx = inc.x + su * fi[ju, 0] + sv * fi[jv, 0] + sn * fi[inc_axis, 0] - cx
        dy = inc.y + su * fi[ju, 1] + sv * fi[jv, 1] + sn * fi[inc_axis, 1] - cy
        dz = inc.z + su * fi[ju, 2] + sv * fi[jv, 2] + sn * fi[inc_axis, 2] - cz
        vertex = points[k]
        place(
            vertex,
            dx * fr[iu, 0] + dy * fr[iu, 1] + dz * fr[iu, 2],
            dx * fr[iv, 0] + dy * fr[iv, 1] + dz * fr[iv, 2],
            dx * nx + dy * ny + dz * nz,
            0.0,
            0,
        )
        vertex.in_line, vertex.out_line = (k + 3) % 4, k
    # A vertex on a side but for round-off is inside, or aligned boxes would rename their points.
    limit_u, limit_v = hr[iu] + TOUCHING, hr[iv] + TOUCHING
    # Four cuts swing the polygon between rows 0.. and 8..; it gains at most one vertex a cut.
    count = cut(points, 0, 4, 8, 0, -1.0, limit_u, 4)
    count = cut(points, 8, count, 0, 0, 1.0, limit_u, 5)
    count = cut(points, 0, count, 8, 1, -1.0, limit_v, 6)
    count = cut(points, 8, count, 0, 1, 1.0, limit_v, 7)
    face = 2 * axis + (1 if side > 0.0 else 0)
    inc_face = 2 * inc_axis + (1 if inc_side > 0.0 else 0)
    first = base + face * 3 * 64 + (inc_face // 2) * 64
    kept = 0
    for k in range(count):
        p = points[k]
        if p.z <= margin:
            u = min(max(p.x, -hr[iu]), hr[iu])
            v = min(max(p.y, -hr[iv]), hr[iv])
            phi = p.z
            in_line, out_line = p.in_line, p.out_line
            half = 0.5 * phi
            place(
                points[kept],
                cx + u * fr[iu, 0] + v * fr[iv, 0] + half * nx,
                cy + u * fr[iu, 1] + v * fr[iv, 1] + half * ny,
                cz + u * fr[iu, 2] + v * fr[iv, 2] + half * nz,
                phi,
                first + 8 * in_line + out_line,
            )
            kept += 1
    return kept
