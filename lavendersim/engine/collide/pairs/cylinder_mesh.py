"""Manifold of a mesh A and a cylinder B: its rims on faces, its sides and caps on sharp edges.

`manifold.mesh_points` says which points touch; faces are planes, edges are lines.
"""

from __future__ import annotations

from typing import Any

from ...compile import once
from ...spec import Spec
from ..manifold.mesh_points import make_mesh_manifold
from . import convex, cylinder_plane


@once
def make(spec: Spec) -> Any:
    """Return `kernel(mesh, cylinder, margin, scratch) -> count`; it writes `scratch.manifold`."""
    return make_mesh_manifold(spec, cylinder_plane.make(spec), convex.make(spec), pointed=False)
