"""Box: half edges hx, hy, hz [m]; for faces and edges the last row of the tables of hulls."""

from __future__ import annotations

from ...compile import inner, kernel
from ...vectors import Vec3, from_body, into_body
from .polyhedron import box_row, edge_of_facet, facet_along, feature_of_facet, put_loop


@inner
def corner_of(box, corner):
    """Return a corner in the box's frame: bit 0, 1, 2 set where it lies at +x, +y, +z."""
    return Vec3(
        box.hx if corner & 1 else -box.hx,
        box.hy if corner & 2 else -box.hy,
        box.hz if corner & 4 else -box.hz,
    )


def make_support(spec):
    """Return `kernel(body, direction, hulls) -> Vec3`."""

    def box_support(body, direction, hulls):
        local = into_body(body, direction)
        corner = Vec3(
            body.hx if local.x >= 0.0 else -body.hx,
            body.hy if local.y >= 0.0 else -body.hy,
            body.hz if local.z >= 0.0 else -body.hz,
        )
        return from_body(body, corner)

    return kernel(box_support, spec)


def make_half_extents(spec):
    """Return `kernel(body) -> Vec3`."""

    def box_half_extents(body):
        return Vec3(
            abs(body.r00) * body.hx + abs(body.r01) * body.hy + abs(body.r02) * body.hz,
            abs(body.r10) * body.hx + abs(body.r11) * body.hy + abs(body.r12) * body.hz,
            abs(body.r20) * body.hx + abs(body.r21) * body.hy + abs(body.r22) * body.hz,
        )

    return kernel(box_half_extents, spec)


def make_face(spec):
    """Return `kernel(body, n, hulls) -> (face, outward normal)`; face: of the unit box."""

    def box_face(body, n, hulls):
        facet = facet_along(body, box_row(hulls), n, hulls)
        return facet.face, facet.normal

    return kernel(box_face, spec)


def make_feature(spec):
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`."""

    def box_feature(body, centre, n, hulls, outline):
        facet = facet_along(body, box_row(hulls), n, hulls)
        count = put_loop(body, facet, Vec3(body.hx, body.hy, body.hz), centre, hulls, outline)
        return feature_of_facet(facet, count, n, hulls, outline)

    return kernel(box_feature, spec)


def make_edge(spec):
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`: a line, or none."""

    def box_edge(body, centre, n, hulls, outline):
        facet = facet_along(body, box_row(hulls), n, hulls)
        count = put_loop(body, facet, Vec3(body.hx, body.hy, body.hz), centre, hulls, outline)
        return edge_of_facet(facet, count, n, hulls, outline)

    return kernel(box_edge, spec)
