"""Right circular cone of base radius r and height h about z, solid; its apex is at +z.

The origin is the centre of mass, h/4 above the base: apex z = 3/4 h, base z = -h/4.
V = pi r^2 h / 3, J_z = 3/10 r^2, J_x = 3/20 r^2 + 3/80 h^2
h(n) = max(3/4 h n_z, r sqrt(1 - n_z^2) - h/4 n_z)
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field

from lavendersim.cell.shapes.shape import Homogeneous, Length, Primitive, circle
from lavendersim.quantities.quantity import Vector3

# Of a reach along a direction, what round-off takes: apex and rim that reach as far are a side [-].
SAME = 4e-16


class Cone(Primitive):
    """A solid cone about the body's z, its apex at +z, its base h/4 below the centre of mass."""

    kind: Literal["cone"]
    radius: Length = Field(description="[m] of its base")
    height: Length = Field(description="[m] from base to apex")

    @property
    def apex(self) -> float:
        """Return how far the apex is above the centre of mass [m]."""
        return 0.75 * self.height

    @property
    def base(self) -> float:
        """Return how far the base is below the centre of mass [m]."""
        return 0.25 * self.height

    def bounding_radius(self) -> float:
        """Return the distance of the apex or of the rim from the centre of mass [m]."""
        return max(self.apex, math.hypot(self.radius, self.base))

    def thickness(self) -> float:
        """Return diameter or height, whichever is less [m]."""
        return min(2.0 * self.radius, self.height)

    def extent(self, along: Vector3) -> float:
        """Return how far the apex or the rim reaches along a unit direction [m]."""
        return max(self._reaches(along))

    def farthest_point(self, along: Vector3) -> Vector3:
        """Return the apex, a point of the rim, the middle of the side or of the base [m]."""
        x, y, z = along
        across = math.hypot(x, y)
        if across == 0.0:
            return (0.0, 0.0, self.apex if z > 0.0 else -self.base)
        of_apex, of_rim = self._reaches(along)
        share = self.radius / across
        if abs(of_apex - of_rim) <= SAME * (self.radius + self.height):
            return (0.5 * share * x, 0.5 * share * y, 0.25 * self.height)
        if of_apex > of_rim:
            return (0.0, 0.0, self.apex)
        return (share * x, share * y, -self.base)

    def corners(self) -> tuple[Vector3, ...]:
        """Return points of the rim and the apex [m]."""
        return (*circle(self.radius, -self.base), (0.0, 0.0, self.apex))

    def faces(self) -> tuple[tuple[int, ...], ...]:
        """Return base and side as rows of corners that turn left seen from outside."""
        apex = len(self.corners()) - 1
        sides = ((k, (k + 1) % apex, apex) for k in range(apex))
        return (tuple(reversed(range(apex))), *sides)

    def homogeneous(self) -> Homogeneous:
        """Return volume and moments of inertia."""
        square = self.radius * self.radius
        across = 0.15 * square + 0.0375 * self.height * self.height
        volume = math.pi * square * self.height / 3.0
        return Homogeneous(volume, (across, across, 0.3 * square))

    def row(self) -> dict[str, float]:
        """Return radius and how far the base is below the centre of mass."""
        return {"hx": self.radius, "hz": self.base}

    def _reaches(self, along: Vector3) -> tuple[float, float]:
        x, y, z = along
        return self.apex * z, self.radius * math.hypot(x, y) - self.base * z
