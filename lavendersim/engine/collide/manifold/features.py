"""A body and a direction n out of it enter; the face, cap or line that looks that way leaves.

    FACE   a polyhedron's face, turned from n by less than some 18 degrees: its loop of corners
    DISC   a cylinder's cap, likewise: an inscribed octagon whose corners are fixed to the body,
           but for one that is moved to the rim's lowest point when the cap is tilted
    LINE   an edge, a cylinder's side or a capsule's axis, not steeper than some 17 degrees: 2 ends
    POINT  nothing flat looks along n

Corners are relative to A's centre, along the world's axes; loops turn left about the outward
normal. plane: 0..2 outward normal, 3..5 a point of it (a disc's centre), 6 a disc's radius.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel, once
from ...records import BOX, CAPSULE, CYLINDER, SPHERE
from ...rotation import to_body, to_world
from ..convex.hull_geometry import MOST_FACES
from ..convex.separation import make_best_face
from ..convex.support import shapes_in
from ..scratch import CAP_CORNERS

POINT, LINE, FACE, DISC = 0, 1, 2, 3
# Least cosine between n and the normal of a face that counts as looking along n [-].
FACE_COSINE = 0.95
# Greatest slope of a line that counts as across n [-].
LINE_SLOPE = 0.3
# A cap tilted less than this [rad] keeps the octagon of its own: the lowest point of its rim lies
# less than 1e-7 radii deeper, and its direction is mostly noise.
LEVEL = 1e-6
# The side of a cylinder, in names of features; its caps are 0 and 1. Edges come behind all faces.
SIDE = 2
EDGES = MOST_FACES
DIAGONAL = sqrt(0.5)


@inner
def put_corner(body, ox, oy, oz, lx, ly, lz, loop, k):
    """Write the corner (lx, ly, lz) of the body's frame as row k."""
    x, y, z = to_world(body, lx, ly, lz)
    loop[k, 0], loop[k, 1], loop[k, 2] = ox + x, oy + y, oz + z


@inner
def octagon_corner(k):
    """Cosine and sine of k eighths of a turn."""
    if k & 1:
        return (
            DIAGONAL if k == 1 or k == 7 else -DIAGONAL,
            DIAGONAL if k <= 3 else -DIAGONAL,
        )
    if k & 2:
        return 0.0, 1.0 if k == 2 else -1.0
    return 1.0 if k == 0 else -1.0, 0.0


@inner
def put_cap(body, ox, oy, oz, lx, ly, lz, loop, plane):
    """Write the octagon and the disc of the cap that looks along (lx, ly, lz), body frame."""
    up = 1.0 if lz >= 0.0 else -1.0
    for k in range(CAP_CORNERS):
        c, s = octagon_corner(k)
        # Seen from below the octagon turns the other way.
        put_corner(body, ox, oy, oz, body.hx * c, up * body.hx * s, up * body.hz, loop, k)
    across = sqrt(lx * lx + ly * ly)
    if across > LEVEL:
        nearest, best = 0, -2.0
        for k in range(CAP_CORNERS):
            c, s = octagon_corner(k)
            cosine = c * lx + up * s * ly
            if cosine > best:
                nearest, best = k, cosine
        share = body.hx / across
        put_corner(body, ox, oy, oz, share * lx, share * ly, up * body.hz, loop, nearest)
    plane[0], plane[1], plane[2] = body.r02 * up, body.r12 * up, body.r22 * up
    plane[3] = ox + plane[0] * body.hz
    plane[4] = oy + plane[1] * body.hz
    plane[5] = oz + plane[2] * body.hz
    plane[6] = body.hx


@inner
def flattest_edge(loop, count, nx, ny, nz):
    """Edge of the loop whose lower end is highest along n: (edge, its slope)."""
    chosen, best = 0, -1e300
    for k in range(count):
        j = (k + 1) % count
        p = loop[k, 0] * nx + loop[k, 1] * ny + loop[k, 2] * nz
        q = loop[j, 0] * nx + loop[j, 1] * ny + loop[j, 2] * nz
        if min(p, q) > best + 1e-12:
            chosen, best = k, min(p, q)
    j = (chosen + 1) % count
    dx = loop[j, 0] - loop[chosen, 0]
    dy = loop[j, 1] - loop[chosen, 1]
    dz = loop[j, 2] - loop[chosen, 2]
    return chosen, abs(dx * nx + dy * ny + dz * nz) / sqrt(dx * dx + dy * dy + dz * dz)


@once
def make_feature(spec):
    """Return `kernel(body, ox, oy, oz, nx, ny, nz, tables, loop, plane) -> (kind, count, name)`.

    (ox, oy, oz): the body's centre relative to A's [m].
    """
    shapes = shapes_in(spec)
    polyhedra, hulls = not shapes.isdisjoint({"box", "hull"}), "hull" in shapes
    cylinders, capsules, boxes = "cylinder" in shapes, "capsule" in shapes, "box" in shapes
    best_face = make_best_face(spec)

    def feature(body, ox, oy, oz, nx, ny, nz, tables, loop, plane):
        if body.shape == SPHERE:
            return POINT, 0, 0
        if capsules:
            if body.shape == CAPSULE:
                if (
                    body.hz == 0.0
                    or abs(body.r02 * nx + body.r12 * ny + body.r22 * nz) > LINE_SLOPE
                ):
                    return POINT, 0, 0
                put_corner(body, ox, oy, oz, 0.0, 0.0, -body.hz, loop, 0)
                put_corner(body, ox, oy, oz, 0.0, 0.0, body.hz, loop, 1)
                return LINE, 2, 0
        if cylinders:
            if body.shape == CYLINDER:
                lx, ly, lz = to_body(body, nx, ny, nz)
                if abs(lz) >= FACE_COSINE:
                    put_cap(body, ox, oy, oz, lx, ly, lz, loop, plane)
                    return DISC, CAP_CORNERS, 1 if lz >= 0.0 else 0
                if abs(lz) > LINE_SLOPE:
                    return POINT, 0, 0
                share = body.hx / sqrt(lx * lx + ly * ly)
                put_corner(body, ox, oy, oz, share * lx, share * ly, -body.hz, loop, 0)
                put_corner(body, ox, oy, oz, share * lx, share * ly, body.hz, loop, 1)
                return LINE, 2, SIDE
        if polyhedra:
            face, x, y, z = best_face(body, nx, ny, nz, tables)
            row = tables.face_start.shape[0] - 2
            sx = sy = sz = 1.0
            if boxes:
                if body.shape == BOX:
                    sx, sy, sz = body.hx, body.hy, body.hz
            if hulls:
                if body.shape != BOX:
                    row = body.hull
            first = tables.loop_start[face]
            count = tables.loop_start[face + 1] - first
            for k in range(count):
                v = tables.loops[first + k]
                lx, ly, lz = tables.vertices[v, 0], tables.vertices[v, 1], tables.vertices[v, 2]
                put_corner(body, ox, oy, oz, sx * lx, sy * ly, sz * lz, loop, k)
            own = face - tables.face_start[row]
            if x * nx + y * ny + z * nz >= FACE_COSINE:
                plane[0], plane[1], plane[2] = x, y, z
                plane[3], plane[4], plane[5] = loop[0, 0], loop[0, 1], loop[0, 2]
                return FACE, count, own
            edge, slope = flattest_edge(loop, count, nx, ny, nz)
            if slope > LINE_SLOPE:
                return POINT, 0, 0
            # One name and one direction, from whichever of its two faces the edge was found.
            named, j = tables.edges[first + edge], (edge + 1) % count
            if named != first + edge:
                edge, j = j, edge
            px, py, pz = loop[edge, 0], loop[edge, 1], loop[edge, 2]
            qx, qy, qz = loop[j, 0], loop[j, 1], loop[j, 2]
            loop[0, 0], loop[0, 1], loop[0, 2] = px, py, pz
            loop[1, 0], loop[1, 1], loop[1, 2] = qx, qy, qz
            return LINE, 2, EDGES + named - tables.loop_start[tables.face_start[row]]
        return POINT, 0, 0

    return kernel(feature, spec)
