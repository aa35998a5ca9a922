"""Manifold of a mesh A and an ellipsoid B: its points nearest to faces and to edges.

`manifold.mesh_points` says which points touch; faces are planes, edges are lines.
"""

from __future__ import annotations

from typing import Any

from ...compile import once
from ...spec import Spec
from ..manifold.mesh_points import make_mesh_manifold
from . import ellipsoid_convex, ellipsoid_plane


@once
def make(spec: Spec) -> Any:
    """Return `kernel(mesh, ellipsoid, margin, scratch) -> count`; it writes `scratch.manifold`."""
    return make_mesh_manifold(
        spec, ellipsoid_plane.make(spec), ellipsoid_convex.make(spec), pointed=True
    )
