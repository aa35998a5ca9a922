"""Two convex cores enter; their distance, nearest points and normal leave, or that they overlap.

Gilbert, Johnson and Keerthi's walk through the differences w = a - b of points of the two cores,
whose set M holds the origin exactly when the cores overlap. v is the point of the current simplex
nearest to the origin; the support point of M against v joins the simplex until it comes no nearer:

    |v|^2 - v . w <= (rounding)        with v . w / |v| a lower bound of the distance at any time

Coordinates: the world's axes, origin at A's centre; B's centre lies at the offset (ox, oy, oz).
result: 0..2 n from A to B, 3 separation of the cores [m], 4..6 point of A, 7..9 point of B.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel, once
from .simplex import drop_weightless, nearest_on_simplex
from .support import make_support

# What the walk found out.
APART, FARTHER, OVERLAPPING = 0, 1, 2
# Polyhedra end after some ten rounds, cylinders by the tolerance after some thirty.
ROUNDS = 100
# Remaining gap of the squared distance, relative [-]: the distance is then right to half of it.
GAP = 1e-14
# Round-off of the corners' coordinates: a few units in the last place of the sizes [-].
GRAIN = 2e-15
# Closer than this share of the shapes' sizes the direction of v is round-off: they touch [-].
CLOSE = 1e-11


@once
def make_difference(spec):
    """Return `kernel(a, b, ox, oy, oz, dx, dy, dz, tables, row)`: support of A - B along d."""
    support = make_support(spec)

    def difference(a, b, ox, oy, oz, dx, dy, dz, tables, row):
        ax, ay, az = support(a, dx, dy, dz, tables)
        bx, by, bz = support(b, -dx, -dy, -dz, tables)
        bx, by, bz = bx + ox, by + oy, bz + oz
        row[0], row[1], row[2] = ax - bx, ay - by, az - bz
        row[3], row[4], row[5] = ax, ay, az
        row[6], row[7], row[8] = bx, by, bz

    return kernel(difference, spec)


@once
def make_gjk(spec):
    """Return `kernel(a, b, ox, oy, oz, reach, scratch) -> (APART | FARTHER | OVERLAPPING, count)`.

    FARTHER: the cores are more than `reach` apart [m], nothing else is known. OVERLAPPING (or
    touching): the first `count` rows of `scratch.simplex` hold the origin, to round-off.
    """
    difference = make_difference(spec)

    def gjk(a, b, ox, oy, oz, reach, scratch):
        corners, weights, result = scratch.simplex, scratch.weights, scratch.result
        size = a.bound + b.bound
        new = corners[4]
        x, y, z = -ox, -oy, -oz
        if x * x + y * y + z * z < 1e-24 * size * size:
            x, y, z = size, 0.0, 0.0
        squared = 1e300
        count, bound, grain = 0, 0.0, GRAIN * size
        for _ in range(ROUNDS):
            difference(a, b, ox, oy, oz, -x, -y, -z, scratch.hulls, new)
            along = x * new[0] + y * new[1] + z * new[2]
            length = sqrt(x * x + y * y + z * z)
            if along > reach * length:
                return FARTHER, 0
            bound = max(bound, along / length)
            if count > 0:
                if squared - along <= GAP * squared + 1e-16 * size * length:
                    break
                known = False
                for k in range(count):
                    if (
                        corners[k, 0] == new[0]
                        and corners[k, 1] == new[1]
                        and corners[k, 2] == new[2]
                    ):
                        known = True
                if known:
                    break
            # Row 4 waits: when the new corner brings nothing the old simplex must still be there.
            for k in range(9):
                corners[count, k] = new[k]
            inside, px, py, pz = nearest_on_simplex(corners, count + 1, weights, grain)
            if inside and bound <= grain:
                return OVERLAPPING, 4
            nearer = px * px + py * py + pz * pz
            # Inside after a proof of distance is round-off of a thin simplex; so is no gain.
            if inside or not nearer < squared:
                # Restore the weights of the old simplex.
                nearest_on_simplex(corners, count, weights, grain)
                break
            x, y, z, squared = px, py, pz, nearer
            count = drop_weightless(corners, count + 1, weights)
            if squared <= CLOSE * CLOSE * size * size:
                return OVERLAPPING, count
        length = sqrt(squared)
        result[0], result[1], result[2] = -x / length, -y / length, -z / length
        result[3] = length
        for axis in range(6):
            total = 0.0
            for k in range(count):
                total += weights[k] * corners[k, 3 + axis]
            result[4 + axis] = total
        return APART, count

    return kernel(gjk, spec)
