"""Faces and edges of convex polyhedra, by the tables of hull_geometry.py.

A hull is a row of the tables; a box is the last row, the box with half edges 1, stretched.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ...compile import inner
from ...vectors import Vec3, dot, from_body, into_body, minus, position, vector_at
from ..convex.hull_geometry import MOST_FACES
from ..manifold.features import FACE_COSINE, LINE_SLOPE, SAME_COSINE, put_corner, put_line
from ..records import FACE_LOOP, LINE, NO_FEATURE, UNBOUNDED, Feature, put_normal, put_position

# Names of edges come behind those of all faces.
EDGES = MOST_FACES
# Of edges whose lower ends are as high but for this, the first is taken [m].
SAME_HEIGHT = 1e-12


class Facet(NamedTuple):
    """A face of the polyhedron in a row of the tables."""

    row: int
    face: int
    normal: Vec3  # outward, world axes


@inner
def box_row(hulls):
    """Row of the box with half edges 1 in the tables: the last; `face_start` has one more."""
    return hulls.face_start.shape[0] - 2


@inner
def facet_along(body, row, n, hulls):
    """Face of the polyhedron in `row` whose outward normal is nearest to n."""
    starts, normals = hulls.face_start, hulls.normals
    local = into_body(body, n)
    best, chosen = -2.0, starts[row]
    for f in range(starts[row], starts[row + 1]):
        cosine = dot(local, vector_at(normals, f))
        # The margin keeps the choice when two faces are along n equally.
        if cosine > best + SAME_COSINE:
            best, chosen = cosine, f
    return Facet(row, chosen, from_body(body, vector_at(normals, chosen)))


@inner
def put_loop(body, facet, scale, centre, hulls, outline):
    """Write the corners of a face, stretched along the body's axes; returns how many."""
    first = hulls.loop_start[facet.face]
    count = hulls.loop_start[facet.face + 1] - first
    for k in range(count):
        corner = vector_at(hulls.vertices, hulls.loops[first + k])
        local = Vec3(scale.x * corner.x, scale.y * corner.y, scale.z * corner.z)
        put_corner(body, centre, local, outline, k)
    return count


@inner
def flattest_edge(corners, count, n):
    """Edge of the loop whose lower end is highest along n: (edge, its slope)."""
    chosen, best = 0, -UNBOUNDED
    for k in range(count):
        p, q = position(corners[k]), position(corners[(k + 1) % count])
        low = min(dot(p, n), dot(q, n))
        if low > best + SAME_HEIGHT:
            chosen, best = k, low
    d = minus(position(corners[(chosen + 1) % count]), position(corners[chosen]))
    return chosen, abs(dot(d, n)) / sqrt(dot(d, d))


@inner
def feature_of_facet(facet, count, n, hulls, outline):
    """Return the face itself, or its edge that is highest along n; its loop is in `outline`."""
    corners = outline.corners
    if dot(facet.normal, n) >= FACE_COSINE:
        plane = outline.plane[0]
        put_normal(plane, facet.normal)
        put_position(plane, position(corners[0]))
        return Feature(FACE_LOOP, count, facet.face - hulls.face_start[facet.row])
    return edge_of_facet(facet, count, n, hulls, outline)


@inner
def edge_of_facet(facet, count, n, hulls, outline):
    """Return the edge of the face that is highest along n; its loop is in `outline`."""
    corners = outline.corners
    edge, slope = flattest_edge(corners, count, n)
    if slope > LINE_SLOPE:
        return NO_FEATURE
    # One name and one direction, from whichever of its two faces the edge was found.
    first = hulls.loop_start[facet.face]
    named, end = hulls.edges[first + edge], (edge + 1) % count
    if named != first + edge:
        edge, end = end, edge
    put_line(outline, position(corners[edge]), position(corners[end]))
    return Feature(LINE, 2, EDGES + named - hulls.loop_start[hulls.face_start[facet.row]])
