"""The expanding polytope of EPA: a closed mesh of triangles, and its growth to a point beyond it.

The faces seen from the new vertex are flooded from one of them, so what is cut out is connected
whatever rounding says of faces that lie in one plane; its rim, the horizon, is joined to the new
vertex. The mesh is `scratch.Polytope`; edge k of a face leads from its corner k to the next.
"""

from __future__ import annotations

from math import inf, sqrt

from ...compile import inner
from ...vectors import cross, divided, dot, length, minus, position
from ..records import UNBOUNDED, normal_of, put_normal

# A face whose area is below this share of its edges' product has no normal [-].
NO_AREA = 1e-12
NOT_SEEN = -1


@inner
def put_face(polytope, t, i, j, k):
    """Write face `t` through the vertices i j k and its plane; the neighbours stay open."""
    face, corners, vertices = polytope.faces[t], polytope.corners, polytope.vertices
    corners[t, 0], corners[t, 1], corners[t, 2] = i, j, k
    face.alive = 1
    p = position(vertices[i])
    u, w = minus(position(vertices[j]), p), minus(position(vertices[k]), p)
    n = cross(u, w)
    area = length(n)
    if area <= NO_AREA * sqrt(dot(u, u) * dot(w, w)):
        face.nx, face.ny, face.nz, face.offset = 0.0, 0.0, 0.0, UNBOUNDED
        return
    n = divided(n, area)
    put_normal(face, n)
    face.offset = dot(n, p)


@inner
def join(polytope, t, ij, jk, ki):
    """Write the neighbours of face `t`."""
    neighbours = polytope.neighbours
    neighbours[t, 0], neighbours[t, 1], neighbours[t, 2] = ij, jk, ki


@inner
def nearest_face(faces, count):
    """Face whose plane is nearest to the origin, counted negative where the origin is outside."""
    chosen, nearest = 0, inf
    for t in range(count):
        if faces[t].alive and faces[t].offset < nearest:
            chosen, nearest = t, faces[t].offset
    return chosen


@inner
def flood(polytope, vertex, start, slack):
    """Mark the faces joined to `start` that see `vertex`, and queue them; returns how many."""
    faces, neighbours, queue = polytope.faces, polytope.neighbours, polytope.queue
    place = position(polytope.vertices[vertex])
    faces[start].seen_by = vertex
    queue[0] = start
    count, looked = 1, 0
    while looked < count:
        t = queue[looked]
        looked += 1
        for edge in range(3):
            f = neighbours[t, edge]
            face = faces[f]
            if face.seen_by != vertex:
                if dot(normal_of(face), place) - face.offset > slack:
                    face.seen_by = vertex
                    queue[count] = f
                    count += 1
    return count


@inner
def grow(polytope, vertex, count, seen):
    """Replace the first `seen` faces of the queue by a cone to `vertex`; returns the new count.

    -1 when there is no room, or when the horizon touches itself (rounding in thin meshes).
    """
    faces, corners, neighbours = polytope.faces, polytope.corners, polytope.neighbours
    queue, horizon = polytope.queue, polytope.horizon
    for k in range(vertex):
        horizon[k] = -1
    first = count
    for s in range(seen):
        t = queue[s]
        faces[t].alive = 0
        for edge in range(3):
            outer = neighbours[t, edge]
            if faces[outer].seen_by == vertex:
                continue
            i, j = corners[t, edge], corners[t, (edge + 1) % 3]
            if horizon[i] >= 0 or count >= faces.shape[0]:
                return -1
            put_face(polytope, count, i, j, vertex)
            faces[count].seen_by = NOT_SEEN
            neighbours[count, 0] = outer
            for back in range(3):
                if neighbours[outer, back] == t and corners[outer, back] == j:
                    neighbours[outer, back] = count
            horizon[i] = count
            count += 1
    for t in range(first, count):
        following = horizon[corners[t, 1]]
        if following < 0:
            return -1
        neighbours[t, 1] = following
        neighbours[following, 2] = t
    return count
