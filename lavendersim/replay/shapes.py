"""The geometry of a cell's bodies as it is drawn: planes, or convex pieces in the body's frame."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from lavendersim.cell import CellBody, CellConfig, Plane
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.shapes import Piece, bounding_radius, half_space, pieces

Vector = npt.NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
XYZW = [1, 2, 3, 0]  # of a quaternion w x y z: the order that rerun takes


class DrawnBody(NamedTuple):
    """One body's geometry: a plane, or pieces."""

    name: str
    kind: str
    fixed: bool
    pieces: tuple[Piece, ...]
    normal: Vector
    offset: float
    bounding_radius: float  # [m] about the centre of mass; 0 for a plane


def shapes(cell: CellConfig) -> list[DrawnBody]:
    """Return the geometry of every body of a cell, in its order."""
    return [_shape(name, body) for name, body in cell.scene.bodies.items()]


def _shape(name: str, body: CellBody) -> DrawnBody:
    shape, fixed = body.shape, not is_movable(body)
    if isinstance(shape, Plane):
        normal, offset = half_space(shape)
        return DrawnBody(name, shape.kind, fixed, (), normal, offset, 0.0)
    return DrawnBody(name, shape.kind, fixed, pieces(shape), UP, 0.0, bounding_radius(shape))
