"""The geometry of a cell's bodies as it is drawn: planes, meshes, or convex pieces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from lavendersim.cell import (
    Cavity,
    CellBody,
    CellConfig,
    CellMesh,
    Cylinder,
    Drum,
    Plane,
    Sphere,
)
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.quaternions import IDENTITY
from lavendersim.geometry.shapes import Piece, bounding_radius, half_space, pieces

Vector = npt.NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
DRUM_LENGTH = 2.0  # drawn of a drum, in radii
XYZW = [1, 2, 3, 0]  # of a quaternion w x y z: the order that rerun takes


class DrawnBody(NamedTuple):
    """One body's geometry: a plane, a mesh, or pieces, in its frame."""

    name: str
    kind: str
    fixed: bool
    pieces: tuple[Piece, ...]
    normal: Vector
    offset: float
    bounding_radius: float  # [m] about the centre of mass; 0 for a plane
    mesh: CellMesh | None = None


def shapes(cell: CellConfig) -> list[DrawnBody]:
    """Return the geometry of every body of a cell, in its order."""
    return [_shape(name, body) for name, body in cell.scene.bodies.items()]


def _shape(name: str, body: CellBody) -> DrawnBody:
    shape, fixed = body.shape, not is_movable(body)
    if isinstance(shape, Plane):
        normal, offset = half_space(shape)
        return DrawnBody(name, shape.kind, fixed, (), normal, offset, 0.0)
    if isinstance(shape, CellMesh):
        bound = bounding_radius(shape)
        return DrawnBody(name, shape.kind, fixed, (), UP, 0.0, bound, shape)
    drawn = _walls(shape) if isinstance(shape, Cavity) else pieces(shape)
    return DrawnBody(name, shape.kind, fixed, drawn, UP, 0.0, bounding_radius(shape))


def _walls(cavity: Cavity) -> tuple[Piece, ...]:
    """Return what stands for a cavity: a ball, or some of a cylinder that has no end."""
    wall: Sphere | Cylinder = Sphere(kind="sphere", radius=cavity.radius)
    if isinstance(cavity, Drum):
        length = DRUM_LENGTH * cavity.radius
        wall = Cylinder(kind="cylinder", radius=cavity.radius, length=length)
    return (Piece(wall, np.zeros(3), np.array(IDENTITY)),)
