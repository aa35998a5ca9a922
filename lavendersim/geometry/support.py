"""The extent of a shape against a direction (its support function), in plain floats.

Configs are resolved with it, so its digits are those of every machine; for logged poses
`shapes.extent` takes matrices.
"""

from __future__ import annotations

import math

from lavendersim.cell.shapes import Box, Capsule, CellCompound, CellHull, CellSimple, Sphere
from lavendersim.geometry.quaternions import Quaternion, axes, product, to_body, to_world
from lavendersim.geometry.vectors import Vector3, dot


def extent_against(
    shape: CellSimple | CellCompound, orientation: Quaternion, direction: Vector3
) -> float:
    """Return the distance [m] from the centre to the surface's furthest point along -direction."""
    if isinstance(shape, Sphere):
        return shape.radius
    if isinstance(shape, Box):
        return math.fsum(
            0.5 * size * abs(dot(edge, direction))
            for size, edge in zip(shape.size, axes(orientation), strict=True)
        )
    if isinstance(shape, CellHull):
        inward = to_body(orientation, direction)
        return -min(dot(point, inward) for point in shape.points)
    if isinstance(shape, CellCompound):
        return max(
            extent_against(part.shape, product(orientation, part.orientation), direction)
            - dot(to_world(orientation, part.position), direction)
            for part in shape.parts
        )
    slope = min(1.0, abs(dot(axes(orientation)[2], direction)))
    end = 0.5 * shape.length * slope
    if isinstance(shape, Capsule):
        return shape.radius + end
    # (1 - s)(1 + s) keeps the digits that 1 - s^2 loses where the cylinder nearly stands.
    return shape.radius * math.sqrt((1.0 - slope) * (1.0 + slope)) + end
