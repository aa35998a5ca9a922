"""Ellipsoid of semi-axes a, b, c: V = 4/3 pi abc, J_x = (b^2 + c^2)/5.

h(n) = |(a n_x, b n_y, c n_z)|; the point whose normal is n: (a^2 n_x, b^2 n_y, c^2 n_z) / h(n)
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from lavendersim.cell.shapes.shape import Homogeneous, Primitive, ball
from lavendersim.quantities.quantity import Quantity, Vector, Vector3


class Ellipsoid(Primitive):
    """A ball, stretched along the body's x, y, z: smooth, it touches in one point."""

    MOST_POINTS: ClassVar[int] = 1

    kind: Literal["ellipsoid"]
    semi_axes: Annotated[Vector3, Vector(3, Quantity("m", above=0))] = Field(
        description="[m] from the centre to the surface along the body's x, y, z"
    )

    @property
    def size(self) -> Vector3:
        """Return the edges of the box that it just fits, along the body's x, y, z [m]."""
        a, b, c = self.semi_axes
        return (2.0 * a, 2.0 * b, 2.0 * c)

    def bounding_radius(self) -> float:
        """Return the longest semi-axis [m]."""
        return max(self.semi_axes)

    def thickness(self) -> float:
        """Return the shortest axis [m]."""
        return 2.0 * min(self.semi_axes)

    def extent(self, along: Vector3) -> float:
        """Return the height of the plane across a unit direction that touches it [m]."""
        return math.hypot(*self._stretched(along))

    def farthest_point(self, along: Vector3) -> Vector3:
        """Return the point of the surface whose normal is a unit direction [m]."""
        x, y, z = self._stretched(self._stretched(along))
        extent = self.extent(along)
        return (x / extent, y / extent, z / extent)

    def corners(self) -> tuple[Vector3, ...]:
        """Return points of its surface: those of a ball's great circles, stretched [m]."""
        return tuple(self._stretched(point) for point in ball(1.0, 0.0))

    def homogeneous(self) -> Homogeneous:
        """Return volume and moments of inertia."""
        x, y, z = (axis * axis for axis in self.semi_axes)
        moments = ((y + z) / 5.0, (x + z) / 5.0, (x + y) / 5.0)
        return Homogeneous(4.0 / 3.0 * math.pi * math.prod(self.semi_axes), moments)

    def row(self) -> dict[str, float]:
        """Return its semi-axes."""
        return dict(zip(("hx", "hy", "hz"), self.semi_axes, strict=True))

    def _stretched(self, vector: Vector3) -> Vector3:
        x, y, z = vector
        a, b, c = self.semi_axes
        return (a * x, b * y, c * z)
