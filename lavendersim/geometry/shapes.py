"""Sizes of shapes about their centre of mass: bounding radius, thickness, extent along a direction.

All lengths in m. Planes have no centre: they are half-spaces n.x <= offset.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from lavendersim.cell.shapes import Cavity, CellCompound, CellMesh, CellShape, CellSimple, Plane
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

    Of a cavity its own: nothing inside of it is farther from its centre or its axis.

    Of a compound an upper bound: it holds the spheres of its parts.
    """
    match shape:
        case Plane():
            return math.inf
        case Cavity():
            return shape.radius
        case CellMesh():
            return shape.bounding_radius()
        case CellCompound():
            return max(
                math.hypot(*part.position) + bounding_radius(part.shape) for part in shape.parts
            )
    return shape.bounding_radius()


def thickness(shape: CellShape) -> float:
    """Return the least width along the axes of its frame; of a compound, its thinnest part's.

    Infinite for a plane or a cavity, which has no other side.
    """
    match shape:
        case Plane() | Cavity() | CellMesh():
            return math.inf
        case CellCompound():
            return min(thickness(part.shape) for part in shape.parts)
    return shape.thickness()


def extent(shape: CellShape, rotation: Floats, direction: Floats) -> float:
    """Return the distance from the centre to the surface's furthest point along a unit direction.

    rotation: matrix, body to world. This is the support function of the shape.
    """
    match shape:
        case Plane() | Cavity() | CellMesh():
            raise ValueError(f"a {shape.kind} has no extent")
        case CellCompound():
            return max(
                float((rotation @ np.asarray(part.position)) @ direction)
                + extent(part.shape, rotation @ rotation_matrix(part.orientation), direction)
                for part in shape.parts
            )
    x, y, z = (rotation.T @ direction).tolist()
    return shape.extent((x, y, z))


class Piece(NamedTuple):
    """One convex solid of a body, and its place in the body's frame."""

    shape: CellSimple
    position: Floats  # [m] of its centre of mass
    orientation: Floats  # unit quaternion w x y z, piece to body


def pieces(shape: CellShape) -> tuple[Piece, ...]:
    """Return the convex solids that a shape is made of: a compound's parts, or itself."""
    if isinstance(shape, Plane | Cavity | CellMesh):
        return ()
    if isinstance(shape, CellCompound):
        return tuple(
            Piece(part.shape, np.array(part.position), np.array(part.orientation))
            for part in shape.parts
        )
    return (Piece(shape, np.zeros(3), np.array(IDENTITY)),)
