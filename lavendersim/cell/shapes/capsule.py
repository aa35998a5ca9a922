"""Capsule: a cylinder of radius r and length l along z, and a ball cut in halves on its ends.

h(n) = l/2 |n_z| + r. Mass: both with their shares of the volume; a half ball's centre of mass
stands 3/8 r beyond the cylinder's end.
"""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from pydantic import Field

from lavendersim.cell.shapes.shape import Homogeneous, Length, MinkowskiSum, Primitive, ball
from lavendersim.quantities.quantity import Vector3


class Capsule(Primitive):
    """A cylinder along the body's z with a half ball on each end."""

    MOST_POINTS: ClassVar[int] = 2

    kind: Literal["capsule"]
    radius: Length = Field(description="[m]")
    length: Length = Field(description="[m] of the cylinder between the half balls")

    def bounding_radius(self) -> float:
        """Return half its whole length [m]."""
        return 0.5 * self.length + self.radius

    def thickness(self) -> float:
        """Return its diameter [m]."""
        return 2.0 * self.radius

    def extent(self, along: Vector3) -> float:
        """Return how far the ball of one end reaches along a unit direction [m]."""
        return self.radius + 0.5 * self.length * min(1.0, abs(along[2]))

    def farthest_point(self, along: Vector3) -> Vector3:
        """Return the point of one ball, or the middle of the side, that is farthest [m]."""
        x, y, z = along
        end = 0.5 * self.length * (math.copysign(1.0, z) if z else 0.0)
        return (self.radius * x, self.radius * y, end + self.radius * z)

    def corners(self) -> tuple[Vector3, ...]:
        """Return points of great circles of both balls [m]."""
        half = 0.5 * self.length
        return ball(self.radius, half) + ball(self.radius, -half)

    def homogeneous(self) -> Homogeneous:
        """Return volume and moments of inertia."""
        radius, half = self.radius, self.length / 2.0
        square = radius * radius
        bar = math.pi * square * self.length
        across = square / 4.0 + self.length * self.length / 12.0
        balls = 4.0 / 3.0 * math.pi * radius**3
        volume = bar + balls
        # A half ball about its centre of mass has 2/5 r^2 - (3/8 r)^2; it stands half + 3/8 r away.
        ends = 0.4 * square + half * half + 0.75 * half * radius
        across = (bar * across + balls * ends) / volume
        along = (bar * (square / 2.0) + balls * 0.4 * square) / volume
        return Homogeneous(volume, (across, across, along))

    def minkowski_sum(self) -> MinkowskiSum:
        """Return its axis and a ball."""
        return MinkowskiSum(half=(0.0, 0.0, 0.5 * self.length), ball=self.radius)

    def row(self) -> dict[str, float]:
        """Return radius and half length."""
        return {"hx": self.radius, "hz": 0.5 * self.length}
