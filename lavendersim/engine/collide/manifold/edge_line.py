"""A round side along a polyhedron's edge: the two lines are what touches, not the face beside it.

          o axis     The normal n, from the edge to the axis, is within 18 degrees of the face's
       n /           own, as it is where the side lies on the face. But seen along n a line over
face ---* edge       the edge is in the face's outline or out of it by round-off: it would touch
                     in two points or in one.
"""

from __future__ import annotations

from typing import Any

from ...compile import inner, kernel, once
from ...vectors import Vec3, cross, dot, negative
from ..records import FACE_LOOP, LINE, normal_of
from ..shape_kernels import make_edge, make_feature, make_is_polyhedral
from ..shapes import shapes_in
from .line_normal import direction_of
from .patch import PARALLEL

# Cosine below which n is not the face's own normal: `separate` takes the face's where that
# separates no less, to 1e-10 of the sizes, which are 1e-5 rad where the side is round.
BESIDE = 1.0 - 1e-12


@inner
def parallel(one, other):
    """Return whether two lines touch along their overlap, and not where they cross."""
    u, w = direction_of(one), direction_of(other)
    n = cross(u, w)
    return dot(n, n) <= PARALLEL * PARALLEL * dot(u, u) * dot(w, w)


@once
def make_edge_along(spec) -> Any:
    """Return `kernel(a, b, offset, of_a, of_b, scratch) -> (of_a, of_b)`, an edge for a face.

    None where no pair has both a line that is no edge and an edge.
    """
    shapes = shapes_in(spec)
    lines = any(shape.maker("make_feature") and not shape.polyhedral for shape in shapes)
    if not (lines and any(shape.maker("make_edge") for shape in shapes)):
        return None
    feature, edge, is_polyhedral = make_feature(spec), make_edge(spec), make_is_polyhedral(spec)

    def edge_along(a, b, offset, of_a, of_b, scratch):
        n, hulls = normal_of(scratch.separation[0]), scratch.hulls
        one, other = scratch.outline_a, scratch.outline_b
        if of_a.kind == LINE and of_b.kind == FACE_LOOP and not is_polyhedral(a):
            if dot(normal_of(other.plane[0]), negative(n)) < BESIDE:
                found = edge(b, offset, negative(n), hulls, other)
                if found.kind == LINE and parallel(one, other):
                    return of_a, found
                return of_a, feature(b, offset, negative(n), hulls, other)
        elif of_b.kind == LINE and of_a.kind == FACE_LOOP and not is_polyhedral(b):
            if dot(normal_of(one.plane[0]), n) < BESIDE:
                origin = Vec3(0.0, 0.0, 0.0)
                found = edge(a, origin, n, hulls, one)
                if found.kind == LINE and parallel(one, other):
                    return found, of_b
                return feature(a, origin, n, hulls, one), of_b
        return of_a, of_b

    return kernel(edge_along, spec)
