"""Where the bodies of an arrangement stand: tower, pyramid, grid, row, ring, rack.

    tower     z_k = base + down + k (down + up + gap)
    pyramid   row r of n - r bodies:  x = base + (i - (n - r - 1)/2)(width + gap),
              z as in a tower without gap
    grid      origin + (i, j, k) spacing + jitter (2 u - 1), u evenly drawn from [0, 1)
    row       origin + along (sum of the spacings before), a spacing being length + gap by default
    ring      centre + Q radius (cos a, sin a, 0) with a = start + 360 k/count, Q from z to the axis
    rack      row r of r + 1 bodies:  x = tip + r s sqrt(3)/2,  y = tip + (i - r/2) s,
              s = breadth + gap

down and up: how far the turned shape reaches below and above its centre; width: along x, breadth:
along y, length: along the row.
"""

from __future__ import annotations

import math
import random
from itertools import accumulate

from lavendersim.cell.shapes import CellCompound, CellSimple
from lavendersim.experiment.models.arrangements import Arrangement, Grid, Rack, Ring, Row, Tower
from lavendersim.geometry.quaternions import from_axis_angle, to_world
from lavendersim.geometry.support import extent_against
from lavendersim.geometry.vectors import unit
from lavendersim.quantities.quantity import Quaternion, Vector3


def centres(
    arrangement: Arrangement,
    shape: CellSimple | CellCompound,
    orientation: Quaternion,
) -> list[Vector3]:
    """Return the centres of mass [m] in the order of the bodies' numbers."""
    if isinstance(arrangement, Grid):
        return _grid(arrangement)
    if isinstance(arrangement, Row):
        return _row(arrangement, shape, orientation)
    if isinstance(arrangement, Ring):
        return _ring(arrangement)
    if isinstance(arrangement, Rack):
        return _rack(arrangement, shape, orientation)
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


def turns_of(arrangement: Arrangement) -> list[Quaternion] | None:
    """Return the rotation of each body about the origin of the world; None for none."""
    if not isinstance(arrangement, Ring) or not arrangement.turned:
        return None
    return [from_axis_angle(arrangement.axis, degrees) for degrees in _angles(arrangement)]


def _length(shape: CellSimple | CellCompound, orientation: Quaternion, along: Vector3) -> float:
    """Return how long a turned shape is along a direction [m]."""
    x, y, z = along
    behind = extent_against(shape, orientation, along)
    return behind + extent_against(shape, orientation, (-x, -y, -z))


def _row(row: Row, shape: CellSimple | CellCompound, orientation: Quaternion) -> list[Vector3]:
    along = unit(row.along)
    spacing = row.spacing
    if spacing is None:
        spacing = _length(shape, orientation, along) + (row.gap or 0.0)
    if isinstance(spacing, tuple):
        distances = [0.0, *accumulate(spacing)]
    else:
        distances = [k * spacing for k in range(row.count)]
    x, y, z = row.origin
    return [(x + s * along[0], y + s * along[1], z + s * along[2]) for s in distances]


def _angles(ring: Ring) -> list[float]:
    return [ring.start_degrees + 360.0 * k / ring.count for k in range(ring.count)]


def _ring(ring: Ring) -> list[Vector3]:
    x, y, z = unit(ring.axis)
    # the shortest rotation from z to the axis; of an axis along -z, half a turn about x
    onto: Quaternion = (0.0, 1.0, 0.0, 0.0) if z <= -1.0 else unit((1.0 + z, -y, x, 0.0))
    places = []
    for degrees in _angles(ring):
        angle = math.radians(degrees)
        flat = (ring.radius * math.cos(angle), ring.radius * math.sin(angle), 0.0)
        places.append(_sum(ring.centre, to_world(onto, flat)))
    return places


def _rack(rack: Rack, shape: CellSimple | CellCompound, orientation: Quaternion) -> list[Vector3]:
    spacing = _length(shape, orientation, (0.0, 1.0, 0.0)) + rack.gap
    x, y, z = rack.tip
    return [
        (x + row * spacing * math.sqrt(0.75), y + (i - 0.5 * row) * spacing, z)
        for row in range(rack.rows)
        for i in range(row + 1)
    ]


def _sum(one: Vector3, other: Vector3) -> Vector3:
    return (one[0] + other[0], one[1] + other[1], one[2] + other[2])


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
