"""Faces and edges of convex polyhedra, by the tables of hull_geometry.py.

A hull is a row of the tables; a box is the last row, the box with half edges 1, stretched.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ...compile import inner
from ...vectors import Vec3, dot, from_body, into_body, minus, position
from ..convex.hull_geometry import MOST_FACES
from ..manifold.features import FACE_COSINE, LINE_SLOPE, put_corner, put_line
from ..records import FACE_LOOP, LINE, NO_FEATURE, Feature, put_normal, put_position

# Names of edges come behind those of all faces.
EDGES = MOST_FACES


class Facet(NamedTuple):
    """A face of the polyhedron in a row of the tables."""

    row: int
    face: int
    normal: Vec3  # outward, world axes


@inner
def facet_along(body, row, n, hulls):
    """Face of the polyhedron in `row` whose outward normal is nearest to n."""
    starts, normals = hulls.face_start, hulls.normals
    local = into_body(body, n)
    best, chosen = -2.0, starts[row]
    for f in range(starts[row], starts[row + 1]):
        cosine = local.x * normals[f, 0] + local.y * normals[f, 1] + local.z * normals[f, 2]
        # The margin keeps the choice when two faces are along n equally.
        if cosine > best + 1e-9:
            best, chosen = cosine, f
    normal = Vec3(normals[chosen, 0], normals[chosen, 1], normals[chosen, 2])
    return Facet(row, chosen, from_body(body, normal))


@inner
def put_loop(body, facet, scale, centre, hulls, outline):
    """Write the corners of a face, stretched along the body's axes; returns how many."""
    first = hulls.loop_start[facet.face]
    count = hulls.loop_start[facet.face + 1] - first
    for k in range(count):
        v = hulls.loops[first + k]
        x, y, z = hulls.vertices[v, 0], hulls.vertices[v, 1], hulls.vertices[v, 2]
        put_corner(body, centre, Vec3(scale.x * x, scale.y * y, scale.z * z), outline, k)
    return count


@inner
def flattest_edge(corners, count, n):
    """Edge of the loop whose lower end is highest along n: (edge, its slope)."""
    chosen, best = 0, -1e300
    for k in range(count):
        p, q = position(corners[k]), position(corners[(k + 1) % count])
        low = min(dot(p, n), dot(q, n))
        if low > best + 1e-12:
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
