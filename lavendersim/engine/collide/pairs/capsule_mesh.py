"""Manifold of a mesh A and a capsule B: the ends of its axis on faces, its side on sharp edges.

`manifold.mesh_points` says which points touch; faces are planes, edges are lines.
"""

from __future__ import annotations

from typing import Any

from ...compile import once
from ...spec import Spec
from ..manifold.mesh_points import make_mesh_manifold
from . import capsule_plane, convex


@once
def make(spec: Spec) -> Any:
    """Return `kernel(mesh, capsule, margin, scratch) -> count`; it writes `scratch.manifold`."""
    return make_mesh_manifold(spec, capsule_plane.make(spec), convex.make(spec), pointed=False)
