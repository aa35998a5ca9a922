"""A release in; the position it means out. Also unit vectors and quaternions.

The gap between the body's surface and the plane n.x = offset, measured along n, is

    clearance + phase * sqrt(2 g h) * dt,    h = clearance, g = -gravity.n

so that the centre stands at  n.x = offset + reach + gap,  reach: how far the body's surface lies
below its centre along n (radius; for a box half the sum of |edge . n|). A step at impact falls
sqrt(2 g h) dt, hence phases 0..15/16 sample where in a step the impact falls.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TypeVar

from lavendersim.experiment.quantities import Vector3
from lavendersim.experiment.scene_models import Box, Plane, Release, Sphere

Numbers = TypeVar("Numbers", bound=tuple[float, ...])
Quaternion = tuple[float, float, float, float]


class PlacementError(ValueError):
    """A release that no position satisfies; `body` is the one, `key` what to change."""

    def __init__(self, body: str, key: str, sentence: str) -> None:
        super().__init__(sentence)
        self.body = body
        self.key = key


def unit(vector: Numbers) -> Numbers:
    """Return the vector at length 1; a vector that has it already is returned bit for bit."""
    largest = max(abs(component) for component in vector)
    scaled = [component / largest for component in vector]  # no overflow, no underflow
    length = largest * math.sqrt(sum(component * component for component in scaled))
    if abs(length - 1.0) <= 1e-15:
        return vector
    length = length / largest
    return tuple(component / length for component in scaled)  # type: ignore[return-value]


def rotation_quaternion(axis: Vector3, degrees: float) -> Quaternion:
    """Return the unit quaternion of a right-handed rotation about an axis."""
    half = math.radians(degrees) / 2.0
    x, y, z = unit(axis)
    sine = math.sin(half)
    return (math.cos(half), sine * x, sine * y, sine * z)


def reach(shape: Sphere | Box, orientation: Quaternion, direction: Vector3) -> float:
    """Return the distance [m] from the centre to the surface's furthest point along -direction."""
    if isinstance(shape, Sphere):
        return shape.radius
    return math.fsum(
        0.5 * size * abs(_dot(edge, direction))
        for size, edge in zip(shape.size, _axes(orientation), strict=True)
    )


def released_position(
    name: str,
    release: Release,
    plane: Plane,
    shape: Sphere | Box,
    orientation: Quaternion,
    gravity: Vector3,
    timestep: Fraction,
) -> Vector3:
    """Return the centre of mass [m] of a released body; raises PlacementError."""
    normal = unit(plane.normal)
    gap = release.clearance
    if release.phase:
        pull = -_dot(gravity, normal)  # [m/s^2] towards the plane
        if pull <= 0.0:
            sentence = f"gravity does not pull towards {release.above}, so that there is no impact"
            raise PlacementError(name, "phase", f"phase: {sentence} to shift; leave it out")
        gap += float(release.phase * timestep) * math.sqrt(2.0 * pull * release.clearance)
    distance = plane.offset + reach(shape, orientation, normal) + gap
    nx, ny, nz = normal
    if release.at is None:
        return (nx * distance, ny * distance, nz * distance)
    x, y = release.at
    if abs(nz) < 1e-9:
        sentence = f"at: {release.above} stands upright, x and y do not say how high the body is"
        raise PlacementError(name, "at", f"{sentence}; state a position")
    return (x, y, (distance - nx * x - ny * y) / nz)


def _axes(quaternion: Quaternion) -> tuple[Vector3, Vector3, Vector3]:
    """Return the body's x, y and z axes in the world frame."""
    w, x, y, z = quaternion
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )


def _dot(one: Vector3, other: Vector3) -> float:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
