"""Convex polyhedron in its principal frame; its mass is known where its corners were found."""

from __future__ import annotations

import math
from typing import Literal

from lavendersim.cell.shapes.shape import Convex
from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import Quaternion, Vector3


class CellHull(ResolvedModel, Convex):
    """A convex polyhedron in its principal frame."""

    kind: Literal["hull"]
    points: tuple[Vector3, ...]  # [m] corners
    faces: tuple[tuple[int, ...], ...]  # rows of `points`, counter-clockwise seen from outside
    centre: Vector3  # [m] the centre of mass in the frame as written
    axes: Quaternion  # principal frame to frame as written

    def bounding_radius(self) -> float:
        """Return the distance of the farthest corner [m]."""
        return max(math.hypot(*point) for point in self.points)

    def thickness(self) -> float:
        """Return the least width along the axes of its frame [m]."""
        columns: list[tuple[float, ...]] = list(zip(*self.points, strict=True))
        return min(max(column) - min(column) for column in columns)

    def extent(self, along: Vector3) -> float:
        """Return the distance of its farthest corner along a unit direction [m]."""
        x, y, z = along
        return max(point[0] * x + point[1] * y + point[2] * z for point in self.points)

    def corners(self) -> tuple[Vector3, ...]:
        """Return its corners [m]."""
        return self.points
