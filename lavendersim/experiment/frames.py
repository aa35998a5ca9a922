"""Vectors, quaternions (w, x, y, z; body to world) and symmetric 3x3 matrices in, the same out.

Plain floats and square roots only: a resolved config has the same digits on every machine.
"""

from __future__ import annotations

import math
from typing import TypeVar

from lavendersim.experiment.quantities import Vector3

Numbers = TypeVar("Numbers", bound=tuple[float, ...])
Quaternion = tuple[float, float, float, float]
Matrix = tuple[Vector3, Vector3, Vector3]  # rows

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)
# Off-diagonal elements below this share of the trace are round-off of the sums that made them; to
# follow them would turn symmetric bodies by nothing but that.
NEGLIGIBLE = 1e-14
# Cyclic Jacobi of a 3x3 converges quadratically, in 3 to 5 sweeps.
MOST_SWEEPS = 20


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


def axes(quaternion: Quaternion) -> tuple[Vector3, Vector3, Vector3]:
    """Return the body's x, y and z axes in the world frame: the columns of its matrix."""
    w, x, y, z = quaternion
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )


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


def principal(tensor: Matrix) -> tuple[Vector3, Quaternion]:
    """Return the eigenvalues of a symmetric matrix and the rotation from its eigenvectors' frame.

    Jacobi's method: every turn is less than 45 degrees, so that a matrix that is diagonal already
    keeps its axes, their order and their signs.
    """
    a = [list(row) for row in tensor]
    columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    least = NEGLIGIBLE * (abs(a[0][0]) + abs(a[1][1]) + abs(a[2][2]))
    for _ in range(MOST_SWEEPS):
        turned = False
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if abs(a[p][q]) <= least:
                continue
            turned = True
            tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q])
            t = math.copysign(1.0, tau) / (abs(tau) + math.sqrt(1.0 + tau * tau))
            c = 1.0 / math.sqrt(1.0 + t * t)
            s = t * c
            _turn_rows(a, p, q, c, s)
            a = [list(row) for row in zip(*a, strict=True)]  # symmetric: then the columns
            _turn_rows(a, p, q, c, s)
            _turn_rows(columns, p, q, c, s)
        if not turned:
            break
    return (a[0][0], a[1][1], a[2][2]), _quaternion(columns)


def _turn_rows(rows: list[list[float]], p: int, q: int, c: float, s: float) -> None:
    rows[p], rows[q] = (
        [c * x - s * y for x, y in zip(rows[p], rows[q], strict=True)],
        [s * x + c * y for x, y in zip(rows[p], rows[q], strict=True)],
    )


def _quaternion(columns: list[list[float]]) -> Quaternion:
    """Return the quaternion of a rotation by its columns; Shepperd's choice of the largest."""
    (xx, yx, zx), (xy, yy, zy), (xz, yz, zz) = columns
    candidates = (
        (1 + xx + yy + zz, zy - yz, xz - zx, yx - xy),
        (zy - yz, 1 + xx - yy - zz, xy + yx, xz + zx),
        (xz - zx, xy + yx, 1 - xx + yy - zz, yz + zy),
        (yx - xy, xz + zx, yz + zy, 1 - xx - yy + zz),
    )
    best = max(range(4), key=lambda k: candidates[k][k])
    return unit(candidates[best])
