"""Vectors of three components inside kernels: values without memory, one formula per operation.

The order of the floating-point operations is that of the formula, from left to right: what calls
these has the same bits as the formula written out.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from .compile import inner
from .rotation import to_body, to_world


class Vec3(NamedTuple):
    """A vector or a point; unit and frame are those of what it stands for."""

    x: float
    y: float
    z: float


@inner
def position(record):
    """Return the fields x, y, z of a record."""
    return Vec3(record.x, record.y, record.z)


@inner
def vector_of(array):
    """Return the vector in an array of three."""
    return Vec3(array[0], array[1], array[2])


@inner
def vector_at(rows, k):
    """Return the vector in row k of an array (n, 3)."""
    return Vec3(rows[k, 0], rows[k, 1], rows[k, 2])


@inner
def across(v):
    """Return a vector across v and the axis of its smallest component, as long as the others."""
    if abs(v.x) <= abs(v.y) and abs(v.x) <= abs(v.z):
        return Vec3(0.0, v.z, -v.y)
    if abs(v.y) <= abs(v.z):
        return Vec3(-v.z, 0.0, v.x)
    return Vec3(v.y, -v.x, 0.0)


@inner
def dot(a, b):
    """Return a . b."""
    return a.x * b.x + a.y * b.y + a.z * b.z


@inner
def cross(a, b):
    """Return a x b."""
    return Vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


@inner
def plus(a, b):
    """Return a + b."""
    return Vec3(a.x + b.x, a.y + b.y, a.z + b.z)


@inner
def minus(a, b):
    """Return a - b."""
    return Vec3(a.x - b.x, a.y - b.y, a.z - b.z)


@inner
def plus_scaled(a, s, b):
    """Return a + s b."""
    return Vec3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z)


@inner
def scaled(s, a):
    """Return s a."""
    return Vec3(s * a.x, s * a.y, s * a.z)


@inner
def divided(a, s):
    """Return a / s, which is not the same bits as (1 / s) a."""
    return Vec3(a.x / s, a.y / s, a.z / s)


@inner
def negative(a):
    """Return -a."""
    return Vec3(-a.x, -a.y, -a.z)


@inner
def length(a):
    """Return |a|."""
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z)


@inner
def from_body(body, v):
    """Rotate a vector from the frame of an oriented body to the world's."""
    x, y, z = to_world(body, v.x, v.y, v.z)
    return Vec3(x, y, z)


@inner
def into_body(body, v):
    """Rotate a vector from the world's frame to that of an oriented body."""
    x, y, z = to_body(body, v.x, v.y, v.z)
    return Vec3(x, y, z)
