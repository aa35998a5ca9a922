"""A release in; the position it means out. Also how far shapes reach from their centre.

The gap between the body's surface and the plane n.x = offset, measured along n, is

    clearance + phase * sqrt(2 g h) * dt,    h = clearance, g = -gravity.n

so that the centre stands at  n.x = offset + reach + gap,  reach: how far the body's surface lies
below its centre along n (radius; for a box half the sum of |edge . n|). A step at impact falls
sqrt(2 g h) dt, hence phases 0..15/16 sample where in a step the impact falls.
"""

from __future__ import annotations

import math
from fractions import Fraction

from lavendersim.cell.body import Release
from lavendersim.cell.shapes import Box, Capsule, CellCompound, CellHull, CellSimple, Plane, Sphere
from lavendersim.experiment.text.node import Path
from lavendersim.geometry.quaternions import axes, product, to_body, to_world
from lavendersim.geometry.vectors import dot, unit
from lavendersim.quantities.quantity import Quaternion, Vector3


class SceneError(ValueError):
    """Values that fit their types and make no scene; `path`: the steps to what to change."""

    def __init__(self, path: Path, sentence: str) -> None:
        super().__init__(sentence)
        self.path = path

    def below(self, *steps: str | int) -> SceneError:
        """Return the same with more steps before the path."""
        return SceneError((*steps, *self.path), str(self))


def reach(shape: CellSimple | CellCompound, orientation: Quaternion, direction: Vector3) -> float:
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
            reach(part.shape, product(orientation, part.orientation), direction)
            - dot(to_world(orientation, part.position), direction)
            for part in shape.parts
        )
    slope = min(1.0, abs(dot(axes(orientation)[2], direction)))
    end = 0.5 * shape.length * slope
    if isinstance(shape, Capsule):
        return shape.radius + end
    # (1 - s)(1 + s) keeps the digits that 1 - s^2 loses where the cylinder nearly stands.
    return shape.radius * math.sqrt((1.0 - slope) * (1.0 + slope)) + end


def released_position(
    release: Release,
    plane: Plane,
    shape: CellSimple | CellCompound,
    orientation: Quaternion,
    gravity: Vector3,
    timestep: Fraction,
) -> Vector3:
    """Return the centre of mass [m] of a released body; raises SceneError, path from the body."""
    normal = unit(plane.normal)
    gap = release.clearance
    if release.phase:
        pull = -dot(gravity, normal)  # [m/s^2] towards the plane
        if pull <= 0.0:
            sentence = f"gravity does not pull towards {release.above}, so that there is no impact"
            raise SceneError(("release", "phase"), f"phase: {sentence} to shift; leave it out")
        gap += float(release.phase * timestep) * math.sqrt(2.0 * pull * release.clearance)
    distance = plane.offset + reach(shape, orientation, normal) + gap
    nx, ny, nz = normal
    if release.at is None:
        return (nx * distance, ny * distance, nz * distance)
    x, y = release.at
    if abs(nz) < 1e-9:
        sentence = f"at: {release.above} stands upright, x and y do not say how high the body is"
        raise SceneError(("release", "at"), f"{sentence}; state a position")
    return (x, y, (distance - nx * x - ny * y) / nz)
