"""Manifold of a mesh A and a cone B: rim and apex on faces, its side and base on sharp edges.

`manifold.mesh_points` says which points touch; faces are planes, edges are lines.
"""

from __future__ import annotations

from typing import Any

from ...compile import once
from ...spec import Spec
from ..manifold.mesh_points import make_mesh_manifold
from . import cone_plane, convex


@once
def make(spec: Spec) -> Any:
    """Return `kernel(mesh, cone, margin, scratch) -> count`; it writes `scratch.manifold`."""
    return make_mesh_manifold(spec, cone_plane.make(spec), convex.make(spec), pointed=False)
