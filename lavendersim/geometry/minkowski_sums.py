"""Many solids as Minkowski sums of a box, a disc and a ball, and how far each reaches.

One formula, h(n) = sum_i half_i |n_i| + disc sqrt(1 - n_z^2) + ball, for all that have such a sum
(`Primitive.minkowski_sum`), over arrays; `shapes.extent` takes one solid of any kind.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from lavendersim.cell.shapes import CellShape, Primitive
from lavendersim.cell.shapes.shape import MinkowskiSum
from lavendersim.geometry.rotations import Floats


class Sums(NamedTuple):
    """Solids as Minkowski sums (`MinkowskiSum`); what is none has a ball without end."""

    half: Floats  # (n, 3) edges of the box [m]
    disc: Floats  # (n,) radius [m]
    ball: Floats  # (n,) radius [m]


def sums_of(shapes: Sequence[CellShape]) -> Sums:
    """Return shapes as Minkowski sums."""
    sums = [shape.minkowski_sum() if isinstance(shape, Primitive) else None for shape in shapes]
    known = [one or MinkowskiSum(ball=math.inf) for one in sums]
    return Sums(
        np.array([one.half for one in known], dtype=np.float64).reshape(-1, 3),
        np.array([one.disc for one in known], dtype=np.float64),
        np.array([one.ball for one in known], dtype=np.float64),
    )


def extents(sums: Sums, rotations: Floats, direction: Floats) -> Floats:
    """Return the extent of each solid along a unit direction [m]; inf where that is unknown.

    rotations: (n, 3, 3) body to world.
    """
    along = np.abs(np.einsum("nij,i->nj", rotations, direction))  # in body axes
    across = np.sqrt(np.maximum(0.0, 1.0 - along[:, 2] * along[:, 2]))
    reach: Floats = np.einsum("nj,nj->n", along, sums.half) + sums.disc * across + sums.ball
    return reach
