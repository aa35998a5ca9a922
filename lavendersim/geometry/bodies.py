"""A body of a cell as arrays: its pose as configured, its mass, inertia and lowest point."""

from __future__ import annotations

import numpy as np

from lavendersim.cell.body import CellBody
from lavendersim.cell.shapes import Cavity, CellMesh, Convex, Plane
from lavendersim.geometry.rotations import Floats, rotation_matrix, unit_quaternion
from lavendersim.geometry.shapes import extent


def vector(values: tuple[float, ...]) -> Floats:
    """Return a tuple of numbers as an array."""
    return np.asarray(values, dtype=np.float64)


def is_movable(body: CellBody) -> bool:
    """Return whether contacts and forces move a body."""
    return not (isinstance(body.shape, Plane | Cavity | CellMesh) or body.fixed)


def mass_of(body: CellBody) -> float:
    """Return the mass [kg], 0 for a body that never moves."""
    return body.mass if is_movable(body) and body.mass is not None else 0.0


def inverse_mass(body: CellBody) -> float:
    """Return 1/mass [1/kg], 0 for a body that never moves."""
    return 1.0 / mass_of(body) if is_movable(body) else 0.0


def principal_inertia(body: CellBody) -> Floats:
    """Return the moments of inertia [kg m^2] about the body's own axes; 0 where it never moves."""
    return np.zeros(3) if body.inertia is None else vector(body.inertia)


def rotation_of(body: CellBody) -> Floats:
    """Return the matrix of the orientation as configured, body to world."""
    return rotation_matrix(unit_quaternion(body.orientation))


def inverse_inertia(body: CellBody) -> Floats:
    """Return the inverse inertia in the world frame [1/(kg m^2)]; 0 where it never moves."""
    if not is_movable(body):
        return np.zeros((3, 3))
    turn = rotation_of(body)
    inverse: Floats = turn @ np.diag(1.0 / principal_inertia(body)) @ turn.T
    return inverse


def extent_along(body: CellBody, direction: Floats) -> float:
    """Return how far [m] a body reaches from its centre along a unit direction, as configured."""
    return extent(body.shape, rotation_of(body), direction)


def lowest_point(body: CellBody, normal: Floats) -> Floats:
    """Return the point [m] of the surface farthest against a unit direction, as configured.

    The middle of a side that lies flat; ValueError for a hull or a compound.
    """
    shape, turn = body.shape, rotation_of(body)
    along = turn.T @ normal
    along[np.abs(along) < 1e-14] = 0.0  # a side at right angles, but for round-off
    if not isinstance(shape, Convex):
        raise ValueError(f"no closed form for the lowest point of a {shape.kind}")
    x, y, z = along.tolist()
    point: Floats = vector(body.position) - turn @ vector(shape.farthest_point((x, y, z)))
    return point
