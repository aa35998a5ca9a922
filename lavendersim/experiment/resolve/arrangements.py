"""Where the bodies of an arrangement stand: tower, pyramid, grid.

    tower     z_k = base + down + k (down + up + gap)
    pyramid   row r of n - r bodies:  x = base + (i - (n - r - 1)/2)(width + gap),
              z as in a tower without gap
    grid      origin + (i, j, k) spacing + jitter (2 u - 1), u evenly drawn from [0, 1)

down and up: how far the turned shape reaches below and above its centre; width: along x.
"""

from __future__ import annotations

import random

from lavendersim.cell.shapes import CellCompound, CellSimple
from lavendersim.experiment.models.arrangements import Grid, Pyramid, Tower
from lavendersim.geometry.support import extent_against
from lavendersim.quantities.quantity import Quaternion, Vector3


def centres(
    arrangement: Tower | Pyramid | Grid,
    shape: CellSimple | CellCompound,
    orientation: Quaternion,
) -> list[Vector3]:
    """Return the centres of mass [m] in the order of the bodies' numbers."""
    if isinstance(arrangement, Grid):
        return _grid(arrangement)
    down = extent_against(shape, orientation, (0.0, 0.0, 1.0))
    height = down + extent_against(shape, orientation, (0.0, 0.0, -1.0))
    x, y, z = arrangement.base
    lowest = z + down
    if isinstance(arrangement, Tower):
        step = height + arrangement.gap
        return [(x, y, lowest + k * step) for k in range(arrangement.count)]
    left = extent_against(shape, orientation, (1.0, 0.0, 0.0))
    right = extent_against(shape, orientation, (-1.0, 0.0, 0.0))
    step = left + right + arrangement.gap
    middle = x + 0.5 * (left - right)  # of a shape whose centre is not half way between its sides
    count = arrangement.base_count
    return [
        (middle + (i - 0.5 * (count - row - 1)) * step, y, lowest + row * height)
        for row in range(count)
        for i in range(count - row)
    ]


def _grid(grid: Grid) -> list[Vector3]:
    # Of all generators of the standard library, `random()` alone is promised to give the same
    # numbers in every version.
    draw = random.Random(grid.seed).random
    (nx, ny, nz), (dx, dy, dz), (x, y, z) = grid.counts, grid.spacing, grid.origin
    places = [
        (x + i * dx, y + j * dy, z + k * dz)
        for k in range(nz)
        for j in range(ny)
        for i in range(nx)
    ]
    if not grid.jitter:
        return places

    def moved(coordinate: float) -> float:
        return coordinate + grid.jitter * (2.0 * draw() - 1.0)

    return [(moved(x), moved(y), moved(z)) for x, y, z in places]
