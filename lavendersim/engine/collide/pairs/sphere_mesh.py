"""Manifold of a mesh A and a sphere B: where its centre is nearest to faces, edges and corners.

`manifold.mesh_points` says which points touch; faces are planes. Of an edge from e - h to e + h the
nearest point is e + t h with t = (c - e) . h / h^2, within -1 ... 1.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel, once
from ...spec import Spec
from ...vectors import Vec3, dot, length, minus, plus_scaled, position, scaled
from ..manifold.mesh_points import make_mesh_manifold
from ..manifold.point import place, put_manifold_normal
from . import sphere_plane


def make_sphere_edge(spec: Spec) -> Any:
    """Return `kernel(edge, sphere, margin, scratch) -> count`; edge: its middle, half its way."""

    def sphere_edge(edge, sphere, margin, scratch):
        half, centre = Vec3(edge.hx, edge.hy, edge.hz), position(sphere)
        t = dot(minus(centre, position(edge)), half) / dot(half, half)
        nearest = plus_scaled(position(edge), min(max(t, -1.0), 1.0), half)
        d = minus(centre, nearest)
        distance = length(d)
        phi = distance - sphere.hx
        if phi > margin or distance == 0.0:
            return 0
        n = scaled(1.0 / distance, d)
        put_manifold_normal(scratch.manifold, n)
        place(scratch.manifold.points[0], plus_scaled(nearest, 0.5 * phi, n), phi, 0)
        return 1

    return kernel(sphere_edge, spec)


@once
def make(spec: Spec) -> Any:
    """Return `kernel(mesh, sphere, margin, scratch) -> count`; it writes `scratch.manifold`."""
    return make_mesh_manifold(spec, sphere_plane.make(spec), make_sphere_edge(spec), pointed=True)
