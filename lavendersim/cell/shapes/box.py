"""Box of edges a, b, c: V = abc, J_x = (b^2 + c^2)/12, h(n) = (a |n_x| + b |n_y| + c |n_z|)/2."""

from __future__ import annotations

import math
from itertools import product
from typing import Literal

from pydantic import Field

from lavendersim.cell.shapes.shape import Homogeneous, MinkowskiSum, Primitive
from lavendersim.quantities.quantity import BoxSize, Vector3


class Box(Primitive):
    """A rectangular block."""

    kind: Literal["box"]
    size: BoxSize = Field(description="[m] full edge lengths along the body's x, y, z")

    def bounding_radius(self) -> float:
        """Return half its diagonal [m]."""
        return 0.5 * math.hypot(*self.size)

    def thickness(self) -> float:
        """Return its shortest edge [m]."""
        return min(self.size)

    def extent(self, along: Vector3) -> float:
        """Return the distance of its farthest corner along a unit direction [m]."""
        return math.fsum(
            0.5 * edge * abs(part) for edge, part in zip(self.size, along, strict=True)
        )

    def farthest_point(self, along: Vector3) -> Vector3:
        """Return the corner, the middle of the edge or of the side that is farthest [m]."""
        x, y, z = (0.5 * edge * _sign(part) for edge, part in zip(self.size, along, strict=True))
        return (x, y, z)

    def corners(self) -> tuple[Vector3, ...]:
        """Return its eight corners [m]."""
        a, b, c = (0.5 * edge for edge in self.size)
        return tuple(product((-a, a), (-b, b), (-c, c)))

    def homogeneous(self) -> Homogeneous:
        """Return volume and moments of inertia."""
        x, y, z = (edge * edge for edge in self.size)
        moments = ((y + z) / 12.0, (x + z) / 12.0, (x + y) / 12.0)
        return Homogeneous(math.prod(self.size), moments)

    def minkowski_sum(self) -> MinkowskiSum:
        """Return itself."""
        x, y, z = (0.5 * edge for edge in self.size)
        return MinkowskiSum(half=(x, y, z))

    def row(self) -> dict[str, float]:
        """Return its half edges."""
        x, y, z = (0.5 * edge for edge in self.size)
        return {"hx": x, "hy": y, "hz": z}


def _sign(number: float) -> float:
    """Return -1, 0 or 1."""
    return math.copysign(1.0, number) if number else 0.0
