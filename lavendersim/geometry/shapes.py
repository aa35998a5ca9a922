"""Sizes of shapes about their centre of mass: bounding radius, thickness, extent along a direction.

All lengths in m. Planes have no centre: they are half-spaces n.x <= offset.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from lavendersim.cell.shapes import (
    Box,
    Capsule,
    CellCompound,
    CellHull,
    CellShape,
    CellSimple,
    Cylinder,
    Plane,
    Sphere,
)
from lavendersim.geometry.quaternions import IDENTITY
from lavendersim.geometry.rotations import Floats, rotation_matrix


class HalfSpace(NamedTuple):
    """The points n . x <= offset."""

    normal: Floats  # of unit length, outward
    offset: float  # [m]


def half_space(shape: CellShape) -> HalfSpace:
    """Return what a plane bounds; ValueError for any other shape."""
    if not isinstance(shape, Plane):
        raise ValueError(f"a {shape.kind} is no half-space")
    normal = np.asarray(shape.normal, dtype=np.float64)
    return HalfSpace(normal / math.sqrt(float(normal @ normal)), shape.offset)


def bounding_radius(shape: CellShape) -> float:
    """Return the radius of the sphere about the centre of mass that holds the shape; planes: inf.

    Of a compound an upper bound: it holds the spheres of its parts.
    """
    match shape:
        case Plane():
            return math.inf
        case Sphere():
            return shape.radius
        case Box():
            return 0.5 * math.hypot(*shape.size)
        case Capsule():
            return 0.5 * shape.length + shape.radius
        case Cylinder():
            return math.hypot(0.5 * shape.length, shape.radius)
        case CellHull():
            return max(math.hypot(*point) for point in shape.points)
        case CellCompound():
            return max(
                math.hypot(*part.position) + bounding_radius(part.shape) for part in shape.parts
            )


def thickness(shape: CellShape) -> float:
    """Return the least width along the axes of its frame; of a compound, its thinnest part's.

    Infinite for a plane, which has no other side.
    """
    match shape:
        case Plane():
            return math.inf
        case Box():
            return min(shape.size)
        case CellHull():
            return float(np.ptp(np.asarray(shape.points), axis=0).min())
        case CellCompound():
            return min(thickness(part.shape) for part in shape.parts)
        case Cylinder():
            return min(2.0 * shape.radius, shape.length)
    return 2.0 * shape.radius


def extent(shape: CellShape, rotation: Floats, direction: Floats) -> float:
    """Return the distance from the centre to the surface's furthest point along a unit direction.

    rotation: matrix, body to world. This is the support function of the shape.
    """
    match shape:
        case Sphere():
            return shape.radius
        case Box():
            half = 0.5 * np.asarray(shape.size)
            return float(half @ np.abs(rotation.T @ direction))
        case Capsule() | Cylinder():
            slope = min(1.0, abs(float(rotation[:, 2] @ direction)))
            across = math.sqrt(1.0 - slope * slope) if isinstance(shape, Cylinder) else 1.0
            return shape.radius * across + 0.5 * shape.length * slope
        case CellHull():
            return float(np.max(np.asarray(shape.points) @ (rotation.T @ direction)))
        case CellCompound():
            return max(
                float((rotation @ np.asarray(part.position)) @ direction)
                + extent(part.shape, rotation @ rotation_matrix(part.orientation), direction)
                for part in shape.parts
            )
    raise ValueError("a plane has no extent")


class Piece(NamedTuple):
    """One convex solid of a body, and its place in the body's frame."""

    shape: CellSimple
    position: Floats  # [m] of its centre of mass
    orientation: Floats  # unit quaternion w x y z, piece to body


def pieces(shape: CellShape) -> tuple[Piece, ...]:
    """Return the convex solids that a shape is made of: a compound's parts, or itself."""
    if isinstance(shape, Plane):
        return ()
    if isinstance(shape, CellCompound):
        return tuple(
            Piece(part.shape, np.array(part.position), np.array(part.orientation))
            for part in shape.parts
        )
    return (Piece(shape, np.zeros(3), np.array(IDENTITY)),)
