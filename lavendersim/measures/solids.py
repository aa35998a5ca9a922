"""The solids of a scene at their logged poses: their extents, and which may overlap.

A body's size is three numbers, as kernels have them (`Primitive.row`): sphere (radius, 0, 0), box
its half edges, capsule and cylinder (radius, 0, half length along the body's z).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellScene, Plane
from lavendersim.cell.shapes import Primitive
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.geometry.shapes import HalfSpace, half_space
from lavendersim.measures.interfaces import Floats

SPHERE, BOX, CAPSULE, CYLINDER, OTHER = range(5)
KINDS: Final = {"sphere": SPHERE, "box": BOX, "capsule": CAPSULE, "cylinder": CYLINDER}
X, Y, Z = np.eye(3)


class Placed(NamedTuple):
    """Several solids of one kind, in the world."""

    position: Floats  # (n, 3) [m]
    rotation: Floats  # (n, 3, 3) body to world
    size: Floats  # (n, 3) [m]

    def take(self, rows: Any) -> Placed:
        """Return some of them."""
        return Placed(self.position[rows], self.rotation[rows], self.size[rows])


@dataclass(frozen=True)
class Solids:
    """The bodies of a scene that are no planes; columns are rows of the pose table."""

    columns: np.ndarray  # (n,) which body of the log
    kind: np.ndarray  # (n,)
    size: Floats  # (n, 3) [m]
    movable: np.ndarray  # (n,)

    def placed(self, poses: Floats) -> Placed:
        """Return the solids at one row of the pose table (bodies, 7)."""
        chosen = poses[self.columns]
        return Placed(chosen[:, :3], rotation_matrices(chosen[:, 3:]), self.size)


def solids_of(scene: CellScene, names: list[str]) -> tuple[Solids, list[HalfSpace]]:
    """Return the solids and the planes of a scene, the bodies in the order of these names."""
    columns, kinds, sizes, movable, grounds = [], [], [], [], []
    for column, name in enumerate(names):
        body = scene.bodies[name]
        if isinstance(body.shape, Plane):
            grounds.append(half_space(body.shape))
            continue
        columns.append(column)
        kinds.append(KINDS.get(body.shape.kind, OTHER))
        row = body.shape.row() if isinstance(body.shape, Primitive) else {}
        sizes.append([row.get(name, 0.0) for name in ("hx", "hy", "hz")])
        movable.append(is_movable(body))
    table = np.array(sizes, dtype=np.float64).reshape(-1, 3)
    return Solids(np.array(columns, int), np.array(kinds, int), table, np.array(movable)), grounds


def extents(kind: np.ndarray, placed: Placed, direction: Floats) -> Floats:
    """Return the extent of each solid along a unit direction [m]; inf where that is unknown."""
    along = np.einsum("nij,i->nj", placed.rotation, direction)  # in body axes
    radius, half = placed.size[:, 0], placed.size[:, 2]
    boxes = np.einsum("nj,nj->n", np.abs(along), placed.size)
    slope = np.abs(along[:, 2])
    across = np.sqrt(np.maximum(0.0, 1.0 - slope * slope))
    found = [radius, boxes, radius + half * slope, radius * across + half * slope]
    return np.choose(kind, [*found, np.full(len(kind), np.inf)])


def near_pairs(kind: np.ndarray, placed: Placed, movable: np.ndarray) -> tuple[Any, Any]:
    """Return the two columns of pairs whose boxes along the world's axes meet (sweep and prune).

    Sorted by their lower ends along the axis on which the scene is longest, a solid can meet only
    those whose lower end comes before its own upper end.
    """
    half = np.stack([extents(kind, placed, axis) for axis in (X, Y, Z)], axis=1)
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
