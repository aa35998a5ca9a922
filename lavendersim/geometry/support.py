"""The extent of a shape against a direction (its support function), in plain floats.

Configs are resolved with it, so its digits are those of every machine; for logged poses
`shapes.extent` takes matrices.
"""

from __future__ import annotations

from lavendersim.cell.shapes import CellCompound, CellSimple
from lavendersim.geometry.quaternions import Quaternion, product, to_body, to_world
from lavendersim.geometry.vectors import Vector3, dot


def extent_against(
    shape: CellSimple | CellCompound, orientation: Quaternion, direction: Vector3
) -> float:
    """Return the distance [m] from the centre to the surface's furthest point along -direction."""
    if isinstance(shape, CellCompound):
        return max(
            extent_against(part.shape, product(orientation, part.orientation), direction)
            - dot(to_world(orientation, part.position), direction)
            for part in shape.parts
        )
    x, y, z = to_body(orientation, direction)
    return shape.extent((-x, -y, -z))
