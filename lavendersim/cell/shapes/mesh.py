"""Triangle mesh: a surface that other bodies touch from where its normals point.

It has no mass; it stands still, or its motion is prescribed. The body's position is where the
origin of the vertices stands.
"""

from __future__ import annotations

import math
from typing import Literal

from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import Vector3


class CellMesh(ResolvedModel):
    """A surface of triangles, whose corners run counter-clockwise seen from outside."""

    kind: Literal["mesh"]
    vertices: tuple[Vector3, ...]  # [m]
    triangles: tuple[tuple[int, int, int], ...]  # rows of `vertices`

    def bounding_radius(self) -> float:
        """Return how far the farthest corner of a triangle is from the origin [m]."""
        used = {row for triangle in self.triangles for row in triangle}
        return max(math.hypot(*self.vertices[row]) for row in used)
