"""The face of one box clipped to a face of the other: the manifold of two boxes face to face.

Clipping after Sutherland and Hodgman (1974, polygon_clip.py) in coordinates of the reference face:
u and v in the face, w along its outward normal, origin at its centre. A vertex is named by the two
lines that meet in it: the incident face's edges 0..3 and the reference face's sides 4..7. The name
stays the same while the boxes slide, so the contact cache can follow a vertex.

             v        3 ______ 2      lines of the incident face: k leads from vertex k to k + 1
             |         |      |
             +--- u    |______|       sides of the reference face: 4 u-, 5 u+, 6 v-, 7 v+
                      0        1
"""

from __future__ import annotations

from typing import NamedTuple

from ...compile import inner
from ...records import TOUCHING
from ...vectors import Vec3, dot, minus, plus_scaled, scaled, vector_at, vector_of
from ..records import Frame
from .features import SAME_COSINE
from .point import copy_point, place, put_manifold_normal

# Rows of a polygon, two of which are in the manifold's points: four cuts make eight vertices of
# four.
POLYGON_ROWS = 8
# Vertices of a polygon have 64 names, by their two lines of eight each.
LINES = 8
VERTEX_NAMES = LINES * LINES
# Reference faces have three sets of names each, one for each axis of the incident box.
FACE_NAMES = 3 * VERTEX_NAMES
BOX_NAMES = 6 * FACE_NAMES


class ReferenceFace(NamedTuple):
    """A face of the reference box: its axis, 1 or -1 where it looks along it, its first name."""

    axis: int
    sign: float
    first_name: int


class Side(NamedTuple):
    """A side of the reference face: what of an axis is kept, and its name.

    sign * coordinate <= limit, along u (axis 0) or v (axis 1).
    """

    axis: int
    sign: float
    limit: float
    line: int


@inner
def axis_of(box, k):
    """Return an axis of a `BoxFrame` [-]."""
    return vector_at(box.axes, k)


@inner
def centre_of(box):
    """Return the centre of a `BoxFrame` [m]."""
    return vector_of(box.centre)


@inner
def incident_axis(incident, n):
    """Axis and side of the face of the incident box whose normal opposes n most."""
    axis, steepest = 0, 0.0
    for k in range(3):
        along = dot(axis_of(incident, k), n)
        # The margin keeps the choice when two faces oppose n equally.
        if abs(along) > abs(steepest) + SAME_COSINE:
            axis, steepest = k, along
    return axis, (-1.0 if steepest > 0.0 else 1.0)


@inner
def cut(points, start, count, side):
    """Keep the part of a polygon that lies inside a side; returns the new count.

    Reads `count` vertices from row `start` and writes the other polygon. x, y hold u, v; z holds w.
    """
    kept, target = 0, POLYGON_ROWS - start
    for k in range(count):
        p = points[start + k]
        q = points[start + (k + 1) % count]
        p_over = side.sign * (p.x if side.axis == 0 else p.y) - side.limit
        q_over = side.sign * (q.x if side.axis == 0 else q.y) - side.limit
        if p_over <= 0.0:
            copy_point(p, points[target + kept])
            kept += 1
        if (p_over <= 0.0) != (q_over <= 0.0):
            share = p_over / (p_over - q_over)
            r = points[target + kept]
            place(r, plus_scaled(p, share, minus(q, p)), 0.0, 0)
            # Leaving the kept side the new vertex ends the edge; entering, it begins the edge.
            if p_over <= 0.0:
                r.in_line, r.out_line = p.out_line, side.line
            else:
                r.in_line, r.out_line = side.line, p.out_line
            kept += 1
    return kept


@inner
def put_incident_face(points, incident, axis, sign, origin, frame):
    """Write the four vertices of the incident face in coordinates of the reference face."""
    ju, jv = (axis + 1) % 3, (axis + 2) % 3
    along_u, along_v, along_n = (
        axis_of(incident, ju),
        axis_of(incident, jv),
        axis_of(incident, axis),
    )
    half, centre = incident.half, centre_of(incident)
    for k in range(4):
        su = half[ju] if k == 1 or k == 2 else -half[ju]
        sv = half[jv] if k >= 2 else -half[jv]
        sn = sign * half[axis]
        p = plus_scaled(plus_scaled(plus_scaled(centre, su, along_u), sv, along_v), sn, along_n)
        d = minus(p, origin)
        vertex = points[k]
        place(vertex, Vec3(dot(d, frame.t1), dot(d, frame.t2), dot(d, frame.n)), 0.0, 0)
        vertex.in_line, vertex.out_line = (k + 3) % 4, k


@inner
def clip_incident_face(reference, incident, face, margin, manifold):
    """Write the manifold on the reference face; returns the count (at most 8).

    reference, incident: `BoxFrame` of the boxes. n is the outward normal of the reference face.
    """
    points, axis, half = manifold.points, face.axis, reference.half
    outward = axis_of(reference, axis)
    n = scaled(face.sign, outward)
    put_manifold_normal(manifold, n)
    iu, iv = (axis + 1) % 3, (axis + 2) % 3
    u, v = axis_of(reference, iu), axis_of(reference, iv)
    origin = plus_scaled(centre_of(reference), half[axis], n)
    inc_axis, inc_sign = incident_axis(incident, n)
    put_incident_face(points, incident, inc_axis, inc_sign, origin, Frame(u, v, n))
    # A vertex on a side but for round-off is inside, or aligned boxes would rename their points.
    limit_u, limit_v = half[iu] + TOUCHING, half[iv] + TOUCHING
    # Four cuts swing the polygon between its two places; it gains at most one vertex a cut.
    count = cut(points, 0, 4, Side(0, -1.0, limit_u, 4))
    count = cut(points, POLYGON_ROWS, count, Side(0, 1.0, limit_u, 5))
    count = cut(points, 0, count, Side(1, -1.0, limit_v, 6))
    count = cut(points, POLYGON_ROWS, count, Side(1, 1.0, limit_v, 7))
    number = 2 * axis + (1 if face.sign > 0.0 else 0)
    first = face.first_name + number * FACE_NAMES + inc_axis * VERTEX_NAMES
    kept = 0
    for k in range(count):
        p = points[k]
        if p.z <= margin:
            along_u = min(max(p.x, -half[iu]), half[iu])
            along_v = min(max(p.y, -half[iv]), half[iv])
            phi = p.z
            in_line, out_line = p.in_line, p.out_line
            on_face = plus_scaled(plus_scaled(origin, along_u, u), along_v, v)
            middle = plus_scaled(on_face, 0.5 * phi, n)
            place(points[kept], middle, phi, first + LINES * in_line + out_line)
            kept += 1
    return kept
