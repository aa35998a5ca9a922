"""Cylinder of radius r and length l along z.

V = pi r^2 l, J_z = r^2/2, J_x = r^2/4 + l^2/12, h(n) = l/2 |n_z| + r sqrt(1 - n_z^2)
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field

from lavendersim.cell.shapes.shape import Homogeneous, Length, MinkowskiSum, Primitive, circle
from lavendersim.quantities.quantity import Vector3


class Cylinder(Primitive):
    """A round bar along the body's z."""

    kind: Literal["cylinder"]
    radius: Length = Field(description="[m]")
    length: Length = Field(description="[m] from end to end")

    def bounding_radius(self) -> float:
        """Return the distance of the rims from the centre [m]."""
        return math.hypot(0.5 * self.length, self.radius)

    def thickness(self) -> float:
        """Return diameter or length, whichever is less [m]."""
        return min(2.0 * self.radius, self.length)

    def extent(self, along: Vector3) -> float:
        """Return how far a rim reaches along a unit direction [m]."""
        slope = min(1.0, abs(along[2]))
        # (1 - s)(1 + s) keeps the digits that 1 - s^2 loses where the cylinder nearly stands.
        across = math.sqrt((1.0 - slope) * (1.0 + slope))
        return self.radius * across + 0.5 * self.length * slope

    def farthest_point(self, along: Vector3) -> Vector3:
        """Return the point of a rim, the middle of the side or of a cap that is farthest [m]."""
        x, y, z = along
        across = math.sqrt(x * x + y * y)
        end = 0.5 * self.length * (math.copysign(1.0, z) if z else 0.0)
        if across == 0.0:
            return (0.0, 0.0, end)
        return (self.radius * x / across, self.radius * y / across, end)

    def corners(self) -> tuple[Vector3, ...]:
        """Return points of both rims [m]."""
        half = 0.5 * self.length
        return circle(self.radius, half) + circle(self.radius, -half)

    def homogeneous(self) -> Homogeneous:
        """Return volume and moments of inertia."""
        square = self.radius * self.radius
        across = square / 4.0 + self.length * self.length / 12.0
        return Homogeneous(math.pi * square * self.length, (across, across, square / 2.0))

    def minkowski_sum(self) -> MinkowskiSum:
        """Return its axis and a disc."""
        return MinkowskiSum(half=(0.0, 0.0, 0.5 * self.length), disc=self.radius)

    def row(self) -> dict[str, float]:
        """Return radius and half length."""
        return {"hx": self.radius, "hz": 0.5 * self.length}
