"""Manifold of a mesh A and a hull B: its corners on the faces, its edges and faces on sharp edges.

`manifold.mesh_points` says which points touch; faces are planes, edges are lines.
"""

from __future__ import annotations

from typing import Any

from ...compile import once
from ...spec import Spec
from ..manifold.mesh_points import make_mesh_manifold
from . import convex, hull_plane


@once
def make(spec: Spec) -> Any:
    """Return `kernel(mesh, hull, margin, scratch) -> count`; it writes `scratch.manifold`."""
    return make_mesh_manifold(spec, hull_plane.make(spec), convex.make(spec), pointed=False)
