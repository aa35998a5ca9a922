"""The solids of a scene at their logged poses: their extents, and which may overlap.

A body's size is three numbers, as kernels have them (`Primitive.row`): sphere (radius, 0, 0), box
its half edges, capsule and cylinder (radius, 0, half length along the body's z). How far a solid
reaches follows from what it is the Minkowski sum of, which its shape declares.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellScene, Plane
from lavendersim.cell.shapes import CellShape, Primitive
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.meeting_boxes import meeting_boxes
from lavendersim.geometry.minkowski_sums import Sums, extents, sums_of
from lavendersim.geometry.periodic_cell import images_that_reach
from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.geometry.shapes import HalfSpace, half_space
from lavendersim.measures.interfaces import Floats

SPHERE, BOX, CAPSULE, CYLINDER, OTHER = range(5)
KINDS: Final = {"sphere": SPHERE, "box": BOX, "capsule": CAPSULE, "cylinder": CYLINDER}
X, Y, Z = np.eye(3)


class PlacedSolids(NamedTuple):
    """Several solids of one kind, in the world."""

    position: Floats  # (n, 3) [m]
    rotation: Floats  # (n, 3, 3) body to world
    size: Floats  # (n, 3) [m]

    def take(self, rows: Any) -> PlacedSolids:
        """Return some of them."""
        return PlacedSolids(self.position[rows], self.rotation[rows], self.size[rows])


@dataclass(frozen=True)
class Solids:
    """The bodies of a scene that are no planes; columns are rows of the pose table."""

    columns: np.ndarray  # (n,) which body of the log
    kind: np.ndarray  # (n,)
    size: Floats  # (n, 3) [m]
    sums: Sums
    movable: np.ndarray  # (n,)

    def placed(self, poses: Floats) -> PlacedSolids:
        """Return the solids at one row of the pose table (bodies, 7)."""
        chosen = poses[self.columns]
        return PlacedSolids(chosen[:, :3], rotation_matrices(chosen[:, 3:]), self.size)


def solids_of(scene: CellScene, names: list[str]) -> tuple[Solids, list[HalfSpace]]:
    """Return the solids and the planes of a scene, the bodies in the order of these names."""
    columns, grounds = [], []
    for column, name in enumerate(names):
        shape = scene.bodies[name].shape
        if isinstance(shape, Plane):
            grounds.append(half_space(shape))
        else:
            columns.append(column)
    bodies = [scene.bodies[names[column]] for column in columns]
    solids = Solids(
        np.array(columns, int),
        np.array([kind_of(body.shape) for body in bodies], int),
        np.array([size_of(body.shape) for body in bodies], dtype=np.float64).reshape(-1, 3),
        sums_of([body.shape for body in bodies]),
        np.array([is_movable(body) for body in bodies]),
    )
    return solids, grounds


def kind_of(shape: CellShape) -> int:
    """Return which of KINDS a shape is, or OTHER."""
    return KINDS.get(shape.kind, OTHER)


def size_of(shape: CellShape) -> list[float]:
    """Return the three numbers of a shape's size [m]."""
    row = shape.row() if isinstance(shape, Primitive) else {}
    return [row.get(name, 0.0) for name in ("hx", "hy", "hz")]


def near_pairs(
    sums: Sums, placed: PlacedSolids, movable: np.ndarray, periodic: Any = None
) -> tuple[Any, Any]:
    """Return the two columns of pairs of which one can move and whose bounds meet.

    periodic: of a scene, whose images meet, too; no body meets its own.
    """
    half = np.stack([extents(sums, placed.rotation, axis) for axis in (X, Y, Z)], axis=1)
    rows, places = np.arange(len(half)), placed.position
    if periodic is not None:
        rows, places = images_that_reach(places, half, periodic)
    a, b = meeting_boxes(places - half[rows], places + half[rows])
    a, b = rows[a], rows[b]
    if periodic is not None:
        pairs = np.unique(np.sort(np.stack([a, b], axis=1)[a != b], axis=1), axis=0)
        a, b = pairs[:, 0], pairs[:, 1]
    moves = movable[a] | movable[b]
    return a[moves], b[moves]
