"""Rotations of arrays: matrices of quaternions (w, x, y, z), body to world."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from lavendersim.geometry.quaternions import columns

Floats = npt.NDArray[np.float64]


def rotation_matrix(quaternion: npt.ArrayLike) -> Floats:
    """Return the matrix (3, 3) of a unit quaternion."""
    w, x, y, z = np.asarray(quaternion, dtype=np.float64)
    return np.array(columns(w, x, y, z)).T


def rotation_matrices(quaternions: npt.ArrayLike) -> Floats:
    """Return the matrices (n, 3, 3) of quaternions (n, 4), which are brought to unit length."""
    rows = np.asarray(quaternions, dtype=np.float64)
    w, x, y, z = (rows / np.linalg.norm(rows, axis=1)[:, None]).T
    return np.stack([np.stack(column, axis=1) for column in columns(w, x, y, z)], axis=2)


def unit_quaternion(quaternion: npt.ArrayLike) -> Floats:
    """Return a quaternion at unit length."""
    numbers = np.asarray(quaternion, dtype=np.float64)
    return np.asarray(numbers / np.linalg.norm(numbers))


def products(one: Floats, other: Floats) -> Floats:
    """Return quaternions (n, 4) of rotations by `other`, then by `one`, about axes of the world."""
    a, u = one[:, :1], one[:, 1:]
    b, v = other[:, :1], other[:, 1:]
    scalar = a * b - (u * v).sum(axis=1, keepdims=True)
    return np.hstack([scalar, a * v + b * u + np.cross(u, v)])


def turns_between(before: Floats, after: Floats) -> tuple[Floats, Floats]:
    """Return scalar (n,) and vector (n, 3) of after before^-1, world frame, the shorter way round.

    Cosine of half the angle, and sine of half the angle along the axis. Of unit quaternions (n, 4).
    """
    turns = products(after, before * (1.0, -1.0, -1.0, -1.0))
    w, vector = turns[:, 0], turns[:, 1:]
    sign = np.where(w < 0.0, -1.0, 1.0)
    return sign * w, sign[:, None] * vector


def rotated(quaternion: Floats, vectors: Floats) -> Floats:
    """Return vectors (..., 3) turned by a unit quaternion: v + 2 w u x v + 2 u x (u x v)."""
    turn = np.cross(quaternion[1:], vectors) * 2
    return np.asarray(vectors + quaternion[0] * turn + np.cross(quaternion[1:], turn))


def shortest_turn(direction: Floats) -> Floats:
    """Return the quaternion of the shortest rotation that takes z to a unit vector."""
    up = np.array([0.0, 0.0, 1.0])
    cosine = float(up @ direction)
    if cosine < -1 + 1e-12:  # straight down: any horizontal axis does
        return np.array([0.0, 1.0, 0.0, 0.0])
    return unit_quaternion([1 + cosine, *np.cross(up, direction)])


def frame_along(direction: Floats) -> Floats:
    """Return a rotation whose third column is a unit vector: two tangents, then the vector.

    The first tangent stands across the coordinate axis that is farthest from the direction.
    """
    x, y, z = direction.tolist()
    across = ((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0))  # each axis crossed with the direction
    first = across[int(np.argmin(np.abs(direction)))]
    length = math.hypot(*first)
    u, v, w = (component / length for component in first)
    second = (y * w - z * v, z * u - x * w, x * v - y * u)
    return np.array(((u, v, w), second, (x, y, z))).T
