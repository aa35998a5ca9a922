"""Two boxes A and B enter; up to four points leave. Separating axes, then face clipping or edges.

                 n (reference face)
                 ^      . incident face
         +-------|-----/-+
    side |       |    / .|  side planes cut the incident face to a polygon; its vertices on the
         +-----------/---+  inner side of the reference face are the manifold
             reference

Fifteen axes: three face normals of A, three of B, nine cross products of edges. In the frame of A,
with C = R_a^T R_b and t = R_a^T (x_b - x_a), an axis L separates by |t . L| - (r_A + r_B), where r
is the reach of a box along L. The least negative is the axis of least penetration. A face is
preferred to an edge, and A's face to B's, unless the other is clearly better, so that resting
contact does not flicker between equivalent axes.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from ...compile import inner, kernel
from ...records import TOUCHING
from ..convex.gjk import APART, make_gjk
from ..convex.separation import FACE_SHARE
from ..manifold.clip import clip_incident_face
from ..manifold.point import keep_four, place
from ..shape_pair import ShapePair

# A face is kept while its penetration is at most this much deeper than the edges': a share of the
# depth plus a share of the smallest half edge [-]. Smaller: flicker in stacks; larger: true
# edge contacts are reported along a face normal and up to this much too deep.
EDGE_SHARE = 0.95
EDGE_SIZE = 0.005
# Two edges count as parallel below this sine; the face axes cover that direction.
PARALLEL_SINE = 1e-6
# B's face wins over A's only by more than this share of the smallest half edge [-].
FACE_SIZE = 1e-6
# Boxes farther apart than this share of the smallest half edge have their true distance looked for;
# nearer, a face that separates most and meets the other box is as near as it is for stacking [-].
FAR = 0.1
# Features of edge pairs start behind those of faces, whose six by six choices take 64 numbers each.
EDGE_FEATURES = 36 * 64
# Nine pairs of edges of sixteen choices each come before the nearest points of boxes far apart.
NEAREST_FEATURE = EDGE_FEATURES + 9 * 16


@inner
def half_edges(box, out):
    """Write the half edge lengths of `box` [m]."""
    out[0], out[1], out[2] = box.hx, box.hy, box.hz


@inner
def frame_of(box, out):
    """Write the axes of `box` as rows: out[i] is its i-th axis in world coordinates."""
    out[0, 0], out[0, 1], out[0, 2] = box.r00, box.r10, box.r20
    out[1, 0], out[1, 1], out[1, 2] = box.r01, box.r11, box.r21
    out[2, 0], out[2, 1], out[2, 2] = box.r02, box.r12, box.r22


@inner
def deepest_face(t, ha, hb, C, transposed):
    """Least penetrated face of the box whose frame `t` is in: (separation, axis)."""
    best, axis = -np.inf, 0
    for i in range(3):
        reach = ha[i]
        for j in range(3):
            reach += hb[j] * abs(C[j, i] if transposed else C[i, j])
        s = abs(t[i]) - reach
        if s > best:
            best, axis = s, i
    return best, axis


@inner
def deepest_edges(t, ha, hb, C):
    """Least penetrated pair of edges: (separation, edge of A * 3 + edge of B), -1 without any."""
    best, chosen = -np.inf, -1
    for i in range(3):
        i1, i2 = (i + 1) % 3, (i + 2) % 3
        for j in range(3):
            squared = 1.0 - C[i, j] * C[i, j]
            if squared < PARALLEL_SINE * PARALLEL_SINE:
                continue
            j1, j2 = (j + 1) % 3, (j + 2) % 3
            reach = (
                ha[i1] * abs(C[i2, j])
                + ha[i2] * abs(C[i1, j])
                + hb[j1] * abs(C[i, j2])
                + hb[j2] * abs(C[i, j1])
            )
            s = (abs(t[i2] * C[i1, j] - t[i1] * C[i2, j]) - reach) / sqrt(squared)
            if s > best:
                best, chosen = s, 3 * i + j
    return best, chosen


@inner
def edge_contact(a, b, fa, fb, ha, hb, edges, separation, points, normal):
    """Nearest points of one edge of A and one of B; the contact lies half way between them."""
    i, j = edges // 3, edges % 3
    ux, uy, uz = fa[i, 0], fa[i, 1], fa[i, 2]
    wx, wy, wz = fb[j, 0], fb[j, 1], fb[j, 2]
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    length = sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx / length, ny / length, nz / length
    dx, dy, dz = b.x - a.x, b.y - a.y, b.z - a.z
    if nx * dx + ny * dy + nz * dz < 0.0:
        nx, ny, nz = -nx, -ny, -nz
    # The supporting edge of each box: the middle of the edge farthest along n (A) or -n (B).
    px, py, pz = a.x, a.y, a.z
    qx, qy, qz = b.x, b.y, b.z
    feature = EDGE_FEATURES + edges * 16
    for k in range(3):
        if k != i:
            along = fa[k, 0] * nx + fa[k, 1] * ny + fa[k, 2] * nz
            side = ha[k] if along > 0.0 else -ha[k]
            px, py, pz = px + side * fa[k, 0], py + side * fa[k, 1], pz + side * fa[k, 2]
            feature += (1 if along > 0.0 else 0) << (0 if k == (i + 1) % 3 else 1)
        if k != j:
            along = fb[k, 0] * nx + fb[k, 1] * ny + fb[k, 2] * nz
            side = -hb[k] if along > 0.0 else hb[k]
            qx, qy, qz = qx + side * fb[k, 0], qy + side * fb[k, 1], qz + side * fb[k, 2]
            feature += (4 if along > 0.0 else 0) << (0 if k == (j + 1) % 3 else 1)
    # p + s u and q + r w nearest to each other: two linear equations in s and r.
    dx, dy, dz = qx - px, qy - py, qz - pz
    cosine = ux * wx + uy * wy + uz * wz
    du = dx * ux + dy * uy + dz * uz
    dw = dx * wx + dy * wy + dz * wz
    scale = 1.0 / (1.0 - cosine * cosine)
    s = min(max((du - cosine * dw) * scale, -ha[i]), ha[i])
    r = min(max((cosine * du - dw) * scale, -hb[j]), hb[j])
    normal[0], normal[1], normal[2] = nx, ny, nz
    place(
        points[0],
        0.5 * (px + s * ux + qx + r * wx),
        0.5 * (py + s * uy + qy + r * wy),
        0.5 * (pz + s * uz + qz + r * wz),
        separation,
        feature,
    )
    return 1


@inner
def nearest_contact(a, nearest, points, normal):
    """Two boxes that are far apart have one point, between the nearest ones that GJK found."""
    normal[0], normal[1], normal[2] = nearest[0], nearest[1], nearest[2]
    place(
        points[0],
        a.x + 0.5 * (nearest[4] + nearest[7]),
        a.y + 0.5 * (nearest[5] + nearest[8]),
        a.z + 0.5 * (nearest[6] + nearest[9]),
        nearest[3],
        NEAREST_FEATURE,
    )
    return 1


def make(spec):
    """Return `kernel(a, b, points, normal, scratch, margin) -> count`."""
    # Contacts ahead of touching: an axis that separates most bounds the distance from below only.
    ahead = spec.has("speculative")
    gjk: Any = make_gjk(spec) if ahead else None

    def box_box(a, b, points, normal, scratch, margin):
        fa, fb, C = scratch.frame_a, scratch.frame_b, scratch.cosines
        ha, hb, t, t_b = scratch.half_a, scratch.half_b, scratch.offset_a, scratch.offset_b
        dx, dy, dz = b.x - a.x, b.y - a.y, b.z - a.z
        reach = a.bound + b.bound + margin
        if dx * dx + dy * dy + dz * dz > reach * reach:
            return 0
        half_edges(a, ha)
        half_edges(b, hb)
        frame_of(a, fa)
        frame_of(b, fb)
        for i in range(3):
            t[i] = dx * fa[i, 0] + dy * fa[i, 1] + dz * fa[i, 2]
            t_b[i] = dx * fb[i, 0] + dy * fb[i, 1] + dz * fb[i, 2]
            for j in range(3):
                C[i, j] = fa[i, 0] * fb[j, 0] + fa[i, 1] * fb[j, 1] + fa[i, 2] * fb[j, 2]
        s_a, axis_a = deepest_face(t, ha, hb, C, False)
        if s_a > margin:
            return 0
        s_b, axis_b = deepest_face(t_b, hb, ha, C, True)
        if s_b > margin:
            return 0
        s_e, edges = deepest_edges(t, ha, hb, C)
        if s_e > margin:
            return 0
        size = min(min(ha[0], min(ha[1], ha[2])), min(hb[0], min(hb[1], hb[2])))
        s_face = max(s_a, s_b)
        if ahead:
            if s_face > FAR * size or s_e > max(TOUCHING, s_face / EDGE_SHARE + EDGE_SIZE * size):
                status, _ = gjk(a, b, dx, dy, dz, margin, scratch)
                if status != APART:
                    return 0
                if s_face < scratch.result[3] - FACE_SHARE * (a.bound + b.bound):
                    return nearest_contact(a, scratch.result, points, normal)
        touching_edges = edges >= 0 and s_e <= TOUCHING
        if touching_edges and s_e > EDGE_SHARE * s_face + EDGE_SIZE * size:
            return edge_contact(a, b, fa, fb, ha, hb, edges, s_e, points, normal)
        if s_b > s_a + FACE_SIZE * size:
            # B is the reference: its outward normal points back to A.
            side = 1.0 if t_b[axis_b] < 0.0 else -1.0
            count = clip_incident_face(
                b, a, fb, fa, hb, ha, axis_b, side, 18 * 64, points, normal, margin
            )
            normal[0], normal[1], normal[2] = -normal[0], -normal[1], -normal[2]
        else:
            side = 1.0 if t[axis_a] >= 0.0 else -1.0
            count = clip_incident_face(
                a, b, fa, fb, ha, hb, axis_a, side, 0, points, normal, margin
            )
        if ahead:
            if count == 0 and s_face > 0.0:
                # The face that separates most looks past the other box.
                status, _ = gjk(a, b, dx, dy, dz, margin, scratch)
                if status != APART:
                    return 0
                return nearest_contact(a, scratch.result, points, normal)
        return keep_four(points, count, normal[0], normal[1], normal[2])

    return kernel(box_box, spec)


PAIR = ShapePair("box_box", ("box", "box"), make)
