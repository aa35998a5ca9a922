"""Penetration depth and direction of two overlapping convex cores: the expanding polytope, EPA.

G. van den Bergen, Proximity queries and penetration depth computation on 3D game objects, Game
Developers Conference (2001).

Inside the Minkowski difference M a polytope grows. Its face nearest to the origin, at the height d
along n, asks for the support h of M along n. The depth lies between the least d and the least h
seen; they meet at a face of M. The heights are signed, so the first polytope need not hold the
origin: bodies that only just touch are no special case.
"""

from __future__ import annotations

import numpy as np

from ...compile import inner, kernel, once
from ...vectors import dot, minus, position, scaled
from ..records import UNBOUNDED, copy_vertex, normal_of, put_normal
from ..scratch import EPA_VERTICES, SIMPLEX_VERTICES
from .gjk import make_difference
from .polytope import NOT_SEEN, flood, grow, join, nearest_face, put_face
from .simplex import nearest_on_triangle
from .tetrahedron import above_plane, make_tetrahedron, swap_vertices

# Where least height and least support count as equal, as a share of the sizes [-]. Round cores have
# no last face: there it is this larger share, and one of the depth; `separation.ascend` does the
# rest, near the direction found.
FLAT_SIZE = 1e-13
ROUND_SIZE = 1e-5
ROUND_SHARE = 1e-3
# A vertex sees a face from this share of the sizes on; beneath it lies in the face's plane.
SEEN = 1e-14
# Faces belong together when their normals' cosine is above this [-].
ALIGNED = 0.999

# The faces of the first tetrahedron: their vertices, and the neighbours across their edges.
FIRST_CORNERS = np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
FIRST_NEIGHBOURS = np.array([[1, 2, 3], [3, 2, 0], [1, 3, 0], [2, 1, 0]])


@inner
def nearest_in_face(vertices, i, j, k, place):
    """Point of the triangle i j k nearest to a place: (squared distance, `OnTriangle`)."""
    found = nearest_on_triangle(
        minus(position(vertices[i]), place),
        minus(position(vertices[j]), place),
        minus(position(vertices[k]), place),
    )
    return dot(found.point, found.point), found


@inner
def write_witness(polytope, found, count, chosen, depth, slack):
    """Write the points of A and B where the ray along the normal `found` leaves the polytope.

    A face of M may be several triangles: of those in the plane of the face that parts the bodies
    the one that the ray goes through is taken. chosen: vertices of that face when it was found.
    """
    vertices, faces, corners = polytope.vertices, polytope.faces, polytope.corners
    n = normal_of(found)
    exit_point = scaled(depth, n)
    i, j, k = chosen
    best, on = nearest_in_face(vertices, i, j, k, exit_point)
    for t in range(count):
        if faces[t].alive and abs(faces[t].offset - depth) <= slack:
            if dot(n, normal_of(faces[t])) > ALIGNED:
                ti, tj, tk = corners[t, 0], corners[t, 1], corners[t, 2]
                distance, on_t = nearest_in_face(vertices, ti, tj, tk, exit_point)
                if distance < best:
                    best, i, j, k, on = distance, ti, tj, tk, on_t
    p, q, r = vertices[i], vertices[j], vertices[k]
    found.ax = on.p * p.ax + on.q * q.ax + on.r * r.ax
    found.ay = on.p * p.ay + on.q * q.ay + on.r * r.ay
    found.az = on.p * p.az + on.q * q.az + on.r * r.az
    found.bx = on.p * p.bx + on.q * q.bx + on.r * r.bx
    found.by = on.p * p.by + on.q * q.by + on.r * r.by
    found.bz = on.p * p.bz + on.q * q.bz + on.r * r.bz


@inner
def put_tetrahedron(polytope):
    """Make the faces of the first four vertices; returns how many."""
    height, _ = above_plane(polytope.vertices, 3)
    if height > 0.0:
        swap_vertices(polytope.vertices, 1, 2)  # the fourth vertex lies behind 0 1 2
    count = len(FIRST_CORNERS)
    for t in range(count):
        put_face(polytope, t, FIRST_CORNERS[t, 0], FIRST_CORNERS[t, 1], FIRST_CORNERS[t, 2])
        join(polytope, t, FIRST_NEIGHBOURS[t, 0], FIRST_NEIGHBOURS[t, 1], FIRST_NEIGHBOURS[t, 2])
        polytope.faces[t].seen_by = NOT_SEEN
    return count


@once
def make_epa(spec):
    """Return `kernel(a, b, offset, count, curved, scratch)`, which fills `scratch.separation`.

    The first `count` vertices of `scratch.simplex` come from GJK; curved: whether one of the cores
    is round. Where vertices or faces run out, or round-off tears the mesh, it is filled with what
    was found so far, and counted in `scratch.not_converged`.
    """
    difference, tetrahedron = make_difference(spec), make_tetrahedron(spec)

    def epa(a, b, offset, count, curved, scratch):
        polytope, hulls, found = scratch.polytope, scratch.hulls, scratch.separation[0]
        vertices, faces, corners = polytope.vertices, polytope.faces, polytope.corners
        size = a.bound + b.bound
        for k in range(count):
            copy_vertex(scratch.simplex[k], vertices[k])
        tetrahedron(a, b, offset, count, vertices, hulls)
        face_count = put_tetrahedron(polytope)
        chosen = (0, 1, 2)
        least, slack = UNBOUNDED, 0.0
        for vertex in range(SIMPLEX_VERTICES, EPA_VERTICES):
            t = nearest_face(faces, face_count)
            d = faces[t].offset
            if d >= least - slack:
                break
            n = normal_of(faces[t])
            new = vertices[vertex]
            difference(a, b, offset, n, hulls, new)
            h = dot(n, position(new))
            if h < least:
                least = h
                chosen = (corners[t, 0], corners[t, 1], corners[t, 2])
                put_normal(found, n)
                found.distance = -h
                slack = FLAT_SIZE * size
                if curved:
                    slack = ROUND_SIZE * size + ROUND_SHARE * abs(least)
            if h - d <= slack:
                break
            seen = flood(polytope, vertex, t, SEEN * size)
            grown = grow(polytope, vertex, face_count, seen)
            if grown < 0:
                face_count = 0  # the mesh is torn: what was found so far must do
                scratch.not_converged[0].epa += 1
                break
            face_count = grown
        else:
            scratch.not_converged[0].epa += 1
        write_witness(polytope, found, face_count, chosen, least, slack)

    return kernel(epa, spec)
