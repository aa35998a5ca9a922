"""Mesh: what convex kernels see of it is one sharp edge at a time, a segment without a radius.

The row of an edge (`mesh_tables.MeshTables.row`) has its middle in x, y, z, half its way in hx, hy,
hz, along the world's axes, and its number in first_node.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...vectors import Vec3, dot, minus, negative, plus
from ..manifold.features import LINE_SLOPE, put_line
from ..records import LINE, NO_FEATURE, Feature


def make_support(spec):
    """Return `kernel(edge, direction, hulls) -> Vec3`."""

    def edge_support(edge, direction, hulls):
        half = Vec3(edge.hx, edge.hy, edge.hz)
        return half if dot(half, direction) >= 0.0 else negative(half)

    return kernel(edge_support, spec)


def make_feature(spec):
    """Return `kernel(edge, centre, n, hulls, outline) -> Feature`: the edge, or a point."""

    def edge_feature(edge, centre, n, hulls, outline):
        half = Vec3(edge.hx, edge.hy, edge.hz)
        if abs(dot(half, n)) > LINE_SLOPE * sqrt(dot(half, half)):
            return NO_FEATURE
        put_line(outline, minus(centre, half), plus(centre, half))
        return Feature(LINE, 2, edge.first_node)

    return kernel(edge_feature, spec)
