"""The solids of a scene at their logged poses: their extents, and which may overlap.

A body's size is three numbers, as kernels have them (`Primitive.row`): sphere (radius, 0, 0), box
its half edges, capsule and cylinder (radius, 0, half length along the body's z). How far a solid
reaches follows from what it is the Minkowski sum of, which its shape declares.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellScene, Plane
from lavendersim.cell.shapes import CellShape, Primitive
from lavendersim.cell.shapes.shape import MinkowskiSum
from lavendersim.geometry.bodies import is_movable
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


class Sums(NamedTuple):
    """Solids as Minkowski sums (`MinkowskiSum`); what is none has a ball without end."""

    half: Floats  # (n, 3) edges of the box [m]
    disc: Floats  # (n,) radius [m]
    ball: Floats  # (n,) radius [m]


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


def sums_of(shapes: Sequence[CellShape]) -> Sums:
    """Return shapes as Minkowski sums."""
    sums = [shape.minkowski_sum() if isinstance(shape, Primitive) else None for shape in shapes]
    known = [one or MinkowskiSum(ball=math.inf) for one in sums]
    return Sums(
        np.array([one.half for one in known], dtype=np.float64).reshape(-1, 3),
        np.array([one.disc for one in known], dtype=np.float64),
        np.array([one.ball for one in known], dtype=np.float64),
    )


def extents(sums: Sums, placed: PlacedSolids, direction: Floats) -> Floats:
    """Return the extent of each solid along a unit direction [m]; inf where that is unknown."""
    along = np.abs(np.einsum("nij,i->nj", placed.rotation, direction))  # in body axes
    across = np.sqrt(np.maximum(0.0, 1.0 - along[:, 2] * along[:, 2]))
    reach: Floats = np.einsum("nj,nj->n", along, sums.half) + sums.disc * across + sums.ball
    return reach


def near_pairs(sums: Sums, placed: PlacedSolids, movable: np.ndarray) -> tuple[Any, Any]:
    """Return the two columns of pairs whose boxes along the world's axes meet (sweep and prune).

    Sorted by their lower ends along the axis on which the scene is longest, a solid can meet only
    those whose lower end comes before its own upper end.
    """
    half = np.stack([extents(sums, placed, axis) for axis in (X, Y, Z)], axis=1)
    low, high = placed.position - half, placed.position + half
    axis = int(np.argmax(np.ptp(placed.position, axis=0)))
    order = np.argsort(low[:, axis], kind="stable")
    ends = np.searchsorted(low[order, axis], high[order, axis], side="right")
    counts = ends - np.arange(len(order)) - 1
    first = np.repeat(np.arange(len(order)), counts)
    step = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    a, b = order[first], order[first + 1 + step]
    meet = (movable[a] | movable[b]) & np.all((low[a] <= high[b]) & (low[b] <= high[a]), axis=1)
    return a[meet], b[meet]
