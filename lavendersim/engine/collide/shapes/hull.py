"""Convex hull: the row `hull` of the tables of hull_geometry.py, relative to the centre of mass."""

from __future__ import annotations

from ...compile import kernel
from ...vectors import Vec3, dot, from_body, into_body, vector_at
from ..records import UNBOUNDED
from .polyhedron import edge_of_facet, facet_along, feature_of_facet, put_loop


def make_support(spec):
    """Return `kernel(body, direction, hulls) -> Vec3`."""

    def hull_support(body, direction, hulls):
        local = into_body(body, direction)
        vertices = hulls.vertices
        first, last = hulls.vertex_start[body.hull], hulls.vertex_start[body.hull + 1]
        best, farthest = first, -UNBOUNDED
        for k in range(first, last):
            reach = dot(local, vector_at(vertices, k))
            if reach > farthest:
                best, farthest = k, reach
        return from_body(body, vector_at(vertices, best))

    return kernel(hull_support, spec)


def make_face(spec):
    """Return `kernel(body, n, hulls) -> (face, outward normal)`."""

    def hull_face(body, n, hulls):
        facet = facet_along(body, body.hull, n, hulls)
        return facet.face, facet.normal

    return kernel(hull_face, spec)


def make_feature(spec):
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`."""

    def hull_feature(body, centre, n, hulls, outline):
        facet = facet_along(body, body.hull, n, hulls)
        count = put_loop(body, facet, Vec3(1.0, 1.0, 1.0), centre, hulls, outline)
        return feature_of_facet(facet, count, n, hulls, outline)

    return kernel(hull_feature, spec)


def make_edge(spec):
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`: a line, or none."""

    def hull_edge(body, centre, n, hulls, outline):
        facet = facet_along(body, body.hull, n, hulls)
        count = put_loop(body, facet, Vec3(1.0, 1.0, 1.0), centre, hulls, outline)
        return edge_of_facet(facet, count, n, hulls, outline)

    return kernel(hull_edge, spec)
