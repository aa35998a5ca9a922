"""Two bodies and what an interpreted kernel of collision detection says of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import poses
import solid_poses
import solids
from interpreted import Row, interpreted, records

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.convex.hull_geometry import hull_geometry
from lavendersim.engine.collide.scratch import Scratch, allocate_scratch
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import TOUCHING
from lavendersim.engine.spec import Spec


def body(kind: str, half, centre=(0.0, 0.0, 0.0), matrix=None, **properties: Any) -> np.ndarray:
    """Return one body, an array of one row; see `solid_poses.put`."""
    rows = allocate_bodies(solid_poses.EVERY_SHAPE, 1)
    solid_poses.put(rows[0], kind, half, centre, matrix, **properties)
    return rows


def hull(points: np.ndarray, centre=(0.0, 0.0, 0.0), matrix=None) -> tuple[np.ndarray, list]:
    """Return the hull of points about their corners' mean, and the polyhedron it is."""
    polyhedron = solid_poses.triangulated(points)
    ones = (1.0, 1.0, 1.0)
    return body("hull", ones, centre, matrix, hull=0, corners=polyhedron[0]), [polyhedron]


def row(bodies: np.ndarray) -> Row:
    """Return the body as kernels read it."""
    return records(bodies)[0]


def scratch_of(hulls: list) -> Scratch:
    """Return scratch whose rows have their fields by name."""
    return records(allocate_scratch(hull_geometry(hulls)))


def spec_of(*pairs: str, effects: tuple[str, ...] = ("rotation",)) -> Spec:
    return Spec(effects, pairs)


def manifold(
    pair: str, a, b, margin: float = TOUCHING, hulls=(), effects=("rotation",)
) -> poses.Manifold:
    """Return the manifold of two bodies."""
    scratch = scratch_of(list(hulls))
    kernel = interpreted(SHAPE_PAIRS[pair].make(spec_of(pair, effects=effects)))
    count = kernel(row(a), row(b), margin, scratch)
    found = scratch.manifold.points.array[:count]
    places = np.column_stack([found[axis] for axis in "xyz"])
    normal = scratch.manifold.normal.copy()
    return poses.Manifold(places, found["phi"].copy(), found["feature"].copy(), normal)


def solid(bodies: np.ndarray, hulls=()) -> solids.Solid:
    """Return the solid of a body, for the oracle."""
    return solids.solid_of(bodies[0], list(hulls))


def vertices_of(shape: solids.Solid) -> np.ndarray:
    """Return the corners of a box or a hull in the world [m]."""
    if shape.kind == "box":
        local = shape.half * (np.indices((2, 2, 2)).reshape(3, -1).T * 2 - 1)
    else:
        local = shape.corners
    return shape.centre + local @ shape.matrix.T


def vector(record: Any, prefix: str = "") -> np.ndarray:
    """Return the vector in the fields x, y, z of a row, or in those that begin with `prefix`."""
    return np.array([record[f"{prefix}{axis}"] for axis in "xyz"])
