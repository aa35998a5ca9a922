"""Unit quaternions (w, x, y, z) as rotations from a body's frame to the world, in plain floats.

The matrix of q is R = 1 + 2 w [u]x + 2 [u]x [u]x with u = (x, y, z); its columns are the body's
axes in the world. Products and square roots only: equal digits on every machine.
"""

from __future__ import annotations

import math
from typing import Any

from lavendersim.geometry.vectors import Vector3, dot, unit

Quaternion = tuple[float, float, float, float]

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)


def from_axis_angle(axis: Vector3, degrees: float) -> Quaternion:
    """Return the unit quaternion of a right-handed rotation about an axis."""
    half = math.radians(degrees) / 2.0
    x, y, z = unit(axis)
    sine = math.sin(half)
    return (math.cos(half), sine * x, sine * y, sine * z)


def from_axes(columns: list[list[float]]) -> Quaternion:
    """Return the quaternion of a rotation by its columns; the largest element first (Shepperd)."""
    (xx, yx, zx), (xy, yy, zy), (xz, yz, zz) = columns
    candidates = (
        (1 + xx + yy + zz, zy - yz, xz - zx, yx - xy),
        (zy - yz, 1 + xx - yy - zz, xy + yx, xz + zx),
        (xz - zx, xy + yx, 1 - xx + yy - zz, yz + zy),
        (yx - xy, xz + zx, yz + zy, 1 - xx - yy + zz),
    )
    best = max(range(4), key=lambda k: candidates[k][k])
    return unit(candidates[best])


def columns(w: Any, x: Any, y: Any, z: Any) -> tuple[tuple[Any, Any, Any], ...]:
    """Return the three columns of the matrix of a unit quaternion.

    The components are floats, or arrays of one shape for several quaternions at once.
    """
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )


def axes(quaternion: Quaternion) -> tuple[Vector3, Vector3, Vector3]:
    """Return the body's x, y and z axes in the world frame: the columns of its matrix."""
    first, second, third = columns(*quaternion)
    return first, second, third


def to_world(quaternion: Quaternion, vector: Vector3) -> Vector3:
    """Return a vector of the body's frame in the world frame."""
    if quaternion == IDENTITY:
        return vector
    one, two, three = axes(quaternion)
    x, y, z = vector
    return (
        one[0] * x + two[0] * y + three[0] * z,
        one[1] * x + two[1] * y + three[1] * z,
        one[2] * x + two[2] * y + three[2] * z,
    )


def to_body(quaternion: Quaternion, vector: Vector3) -> Vector3:
    """Return a vector of the world frame in the body's frame."""
    if quaternion == IDENTITY:
        return vector
    one, two, three = axes(quaternion)
    return (dot(one, vector), dot(two, vector), dot(three, vector))


def product(one: Quaternion, other: Quaternion) -> Quaternion:
    """Return the rotation that does `other` first, in the frame that `one` turns."""
    if other == IDENTITY:
        return one
    if one == IDENTITY:
        return other
    a, b, c, d = one
    w, x, y, z = other
    return unit(
        (
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        )
    )


def inverse(quaternion: Quaternion) -> Quaternion:
    """Return the opposite rotation of a unit quaternion."""
    w, x, y, z = quaternion
    return quaternion if quaternion == IDENTITY else (w, -x, -y, -z)
