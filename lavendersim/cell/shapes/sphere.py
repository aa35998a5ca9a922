"""Sphere: V = 4/3 pi r^3, J = 2/5 r^2, h(n) = r."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from pydantic import Field

from lavendersim.cell.shapes.shape import Homogeneous, Length, MinkowskiSum, Primitive, ball
from lavendersim.quantities.quantity import Vector3


class Sphere(Primitive):
    """A ball."""

    MOST_POINTS: ClassVar[int] = 1

    kind: Literal["sphere"]
    radius: Length = Field(description="[m]")

    def bounding_radius(self) -> float:
        """Return its radius [m]."""
        return self.radius

    def thickness(self) -> float:
        """Return its diameter [m]."""
        return 2.0 * self.radius

    def extent(self, along: Vector3) -> float:
        """Return its radius [m]."""
        return self.radius

    def farthest_point(self, along: Vector3) -> Vector3:
        """Return the point of the surface in a unit direction [m]."""
        x, y, z = along
        return (self.radius * x, self.radius * y, self.radius * z)

    def corners(self) -> tuple[Vector3, ...]:
        """Return points of great circles [m]."""
        return ball(self.radius, 0.0)

    def homogeneous(self) -> Homogeneous:
        """Return volume and moments of inertia."""
        moment = 0.4 * (self.radius * self.radius)
        return Homogeneous(4.0 / 3.0 * math.pi * self.radius**3, (moment, moment, moment))

    def minkowski_sum(self) -> MinkowskiSum:
        """Return itself."""
        return MinkowskiSum(ball=self.radius)

    def row(self) -> dict[str, float]:
        """Return its radius."""
        return {"hx": self.radius}
