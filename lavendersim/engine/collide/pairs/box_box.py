"""Manifold of two boxes A and B: up to four points, by separating axes and face clipping or edges.

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

from ...compile import inner, kernel, separate
from ...records import TOUCHING
from ...step_terms import step_terms
from ...vectors import Vec3, cross, divided, dot, minus, negative, plus_scaled
from ..convex.gjk import APART, make_gjk
from ..convex.separation import FACE_SHARE
from ..manifold.box_clip import (
    BOX_NAMES,
    ReferenceFace,
    axis_of,
    centre_of,
    clip_incident_face,
)
from ..manifold.point import manifold_normal, place, put_manifold_normal, reduce_manifold
from ..records import normal_of

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
# What lies over that face may be farther than it separates the boxes by this share: an edge that
# turns to it and hangs over its end by little meets it along its whole length, not at one end [-].
NEARLY = 0.01
# Names: faces of A, faces of B, nine pairs of edges of sixteen choices each, witness points.
EDGE_FEATURES = 2 * BOX_NAMES
EDGE_CHOICES = 16
NEAREST_FEATURE = EDGE_FEATURES + 9 * EDGE_CHOICES


@inner
def load_box(body, d, box):
    """Write what is compared of a box; d: from A's centre to B's [m]."""
    axes, half, centre, offset = box.axes, box.half, box.centre, box.offset
    half[0], half[1], half[2] = body.hx, body.hy, body.hz
    centre[0], centre[1], centre[2] = body.x, body.y, body.z
    axes[0, 0], axes[0, 1], axes[0, 2] = body.r00, body.r10, body.r20
    axes[1, 0], axes[1, 1], axes[1, 2] = body.r01, body.r11, body.r21
    axes[2, 0], axes[2, 1], axes[2, 2] = body.r02, body.r12, body.r22
    for i in range(3):
        offset[i] = dot(d, axis_of(box, i))


@inner
def load_cosines(box_a, box_b, C):
    """Write the cosines of the angles between the axes of A and those of B."""
    for i in range(3):
        for j in range(3):
            C[i, j] = dot(axis_of(box_a, i), axis_of(box_b, j))


@inner
def deepest_face(box, other_half, C, transposed):
    """Least penetrated face of a box: (separation, axis); C[own axis, other] or transposed."""
    t, half = box.offset, box.half
    best, axis = -np.inf, 0
    for i in range(3):
        reach = half[i]
        for j in range(3):
            reach += other_half[j] * abs(C[j, i] if transposed else C[i, j])
        s = abs(t[i]) - reach
        if s > best:
            best, axis = s, i
    return best, axis


@inner
def deepest_edges(box_a, hb, C):
    """Least penetrated pair of edges: (separation, edge of A * 3 + edge of B), -1 without any."""
    t, ha = box_a.offset, box_a.half
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
def supporting_edge(box, axis, n, toward):
    """Middle of the edge along `axis` that is farthest along toward * n, and which one it is.

    toward: 1 for A, -1 for B. The second result has bit 0 and 1 set where the edge lies on the
    side that n looks to, along the next axis and the one after.
    """
    p, which = centre_of(box), 0
    for k in range(3):
        if k != axis:
            u = axis_of(box, k)
            along = dot(u, n)
            half = box.half[k]
            p = plus_scaled(p, toward * half if along > 0.0 else -toward * half, u)
            which += (1 if along > 0.0 else 0) << (0 if k == (axis + 1) % 3 else 1)
    return p, which


@inner
def edge_contact(box_a, box_b, edges, separation, manifold):
    """Nearest points of one edge of A and one of B; the contact lies half way between them."""
    i, j = edges // 3, edges % 3
    u, w = axis_of(box_a, i), axis_of(box_b, j)
    n = cross(u, w)
    n = divided(n, sqrt(dot(n, n)))
    if dot(n, minus(centre_of(box_b), centre_of(box_a))) < 0.0:
        n = negative(n)
    p, of_a = supporting_edge(box_a, i, n, 1.0)
    q, of_b = supporting_edge(box_b, j, n, -1.0)
    feature = EDGE_FEATURES + edges * EDGE_CHOICES + of_a + 4 * of_b
    # p + s u and q + r w nearest to each other: two linear equations in s and r.
    d, cosine = minus(q, p), dot(u, w)
    du, dw = dot(d, u), dot(d, w)
    scale = 1.0 / (1.0 - cosine * cosine)
    half_a, half_b = box_a.half[i], box_b.half[j]
    s = min(max((du - cosine * dw) * scale, -half_a), half_a)
    r = min(max((cosine * du - dw) * scale, -half_b), half_b)
    put_manifold_normal(manifold, n)
    middle = Vec3(
        0.5 * (p.x + s * u.x + q.x + r * w.x),
        0.5 * (p.y + s * u.y + q.y + r * w.y),
        0.5 * (p.z + s * u.z + q.z + r * w.z),
    )
    place(manifold.points[0], middle, separation, feature)
    return 1


@inner
def nearest_contact(a, found, manifold):
    """Two boxes that are far apart have one point, between the witness points that GJK found."""
    put_manifold_normal(manifold, normal_of(found))
    middle = Vec3(
        a.x + 0.5 * (found.ax + found.bx),
        a.y + 0.5 * (found.ay + found.by),
        a.z + 0.5 * (found.az + found.bz),
    )
    place(manifold.points[0], middle, found.distance, NEAREST_FEATURE)
    return 1


@inner
def meets(manifold, count, s_face):
    """Return whether a candidate is nearly as near as the face separates the boxes."""
    near = False
    for k in range(count):
        near = near or manifold.points[k].phi <= (1.0 + NEARLY) * s_face
    return near


@inner
def smallest_half_edge(box):
    """Return the smallest half edge of a box [m]."""
    return min(box.half[0], min(box.half[1], box.half[2]))


@inner
def clip_faces(b_is_better, axis_a, axis_b, margin, scratch):
    """Write the manifold of the two boxes face to face; returns the count (at most 8).

    A's face is the reference, or B's where that is clearly the better one.
    """
    manifold = scratch.manifold
    # Clipped in one place for both, which halves what there is to compile.
    if b_is_better:
        reference, incident, axis, names = scratch.box_b, scratch.box_a, axis_b, BOX_NAMES
        outward = scratch.box_b.offset[axis_b] < 0.0  # the offset is of B's centre from A's
    else:
        reference, incident, axis, names = scratch.box_a, scratch.box_b, axis_a, 0
        outward = scratch.box_a.offset[axis_a] >= 0.0
    face = ReferenceFace(axis, 1.0 if outward else -1.0, names)
    count = clip_incident_face(reference, incident, face, margin, manifold)
    if b_is_better:  # B's outward normal points back to A
        put_manifold_normal(manifold, negative(manifold_normal(manifold)))
    return count


def make(spec):
    """Return `kernel(a, b, margin, scratch) -> count`, which writes `scratch.manifold`."""
    # Speculative contacts: an axis that separates most bounds the distance from below only.
    speculative = step_terms(spec).ahead
    gjk: Any = make_gjk(spec) if speculative else None

    def box_box(a, b, margin, scratch):
        box_a, box_b, C = scratch.box_a, scratch.box_b, scratch.cosines
        found, manifold = scratch.separation[0], scratch.manifold
        d = minus(b, a)
        reach = a.bound + b.bound + margin
        if dot(d, d) > reach * reach:
            return 0
        load_box(a, d, box_a)
        load_box(b, d, box_b)
        load_cosines(box_a, box_b, C)
        s_a, axis_a = deepest_face(box_a, box_b.half, C, False)
        if s_a > margin:
            return 0
        s_b, axis_b = deepest_face(box_b, box_a.half, C, True)
        if s_b > margin:
            return 0
        s_e, edges = deepest_edges(box_a, box_b.half, C)
        if s_e > margin:
            return 0
        size = min(smallest_half_edge(box_a), smallest_half_edge(box_b))
        s_face, looks_past = max(s_a, s_b), False
        if speculative:
            if s_face > FAR * size or s_e > max(TOUCHING, s_face / EDGE_SHARE + EDGE_SIZE * size):
                status, _ = gjk(a, b, d, margin, scratch)
                if status != APART:
                    return 0
                looks_past = s_face < found.distance - FACE_SHARE * (a.bound + b.bound)
        touching_edges = edges >= 0 and s_e <= TOUCHING
        if touching_edges and s_e > EDGE_SHARE * s_face + EDGE_SIZE * size:
            return edge_contact(box_a, box_b, edges, s_e, manifold)
        count = clip_faces(s_b > s_a + FACE_SIZE * size, axis_a, axis_b, margin, scratch)
        if speculative:
            if looks_past and not meets(manifold, count, s_face):
                return nearest_contact(a, found, manifold)
            if count == 0 and s_face > 0.0:
                # The face that separates most looks past the other box.
                status, _ = gjk(a, b, d, margin, scratch)
                if status != APART:
                    return 0
                return nearest_contact(a, found, manifold)
        return reduce_manifold(manifold, manifold.points, count, manifold_normal(manifold))

    return separate(kernel(box_box, spec), spec)
