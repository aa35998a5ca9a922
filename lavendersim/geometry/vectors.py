"""Vectors of three plain floats: products, differences and unit length."""

from __future__ import annotations

import math
from typing import TypeVar

Numbers = TypeVar("Numbers", bound=tuple[float, ...])
Vector3 = tuple[float, float, float]
Matrix = tuple[Vector3, Vector3, Vector3]  # rows


def unit(vector: Numbers) -> Numbers:
    """Return the vector at length 1; a vector that has it already is returned bit for bit."""
    largest = max(map(abs, vector))
    scaled = [component / largest for component in vector]  # no overflow, no underflow
    length = largest * math.sqrt(sum([component * component for component in scaled]))
    if abs(length - 1.0) <= 1e-15:
        return vector
    length = length / largest
    return tuple(component / length for component in scaled)  # type: ignore[return-value]


def dot(one: Vector3, other: Vector3) -> float:
    """Return the scalar product."""
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def cross(one: Vector3, other: Vector3) -> Vector3:
    """Return the vector product."""
    return (
        one[1] * other[2] - one[2] * other[1],
        one[2] * other[0] - one[0] * other[2],
        one[0] * other[1] - one[1] * other[0],
    )


def minus(one: Vector3, other: Vector3) -> Vector3:
    """Return the difference."""
    return (one[0] - other[0], one[1] - other[1], one[2] - other[2])
