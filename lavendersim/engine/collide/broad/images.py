"""Images of bodies for the tree of a periodic cell: as many as reach into it.

Each body stands in the cell from 0 to L once, and once more a period away on every side where its
bounds leave the cell. Two bodies whose bounds meet across a face meet there as one of them and an
image of the other; what is found twice, or as two images, has one row of pairs.
"""

from __future__ import annotations

from math import floor
from typing import Any

import numpy as np

from ...compile import inner, kernel
from ...spec import Spec
from .tree import make_complete_leaf, make_has_leaf, sort_by_code, sort_code

ALONG_AN_AXIS = 3  # images: a period below, in the cell, a period above
ALL = ALONG_AN_AXIS**3


def most_images(bodies: np.ndarray) -> int:
    """Return how many images a body may have at most, itself included."""
    names = bodies.dtype.names or ()
    axes = [axis for axis in "xyz" if f"period_{axis}" in names]
    periodic = [axis for axis in axes if np.any(bodies[f"period_{axis}"] > 0.0)]
    return int(ALONG_AN_AXIS ** len(periodic))


@inner
def wrapped(x, period):
    """Return a coordinate within [0, period); period 0: as it is [m]."""
    if period > 0.0:
        return x - period * floor(x / period)
    return x


@inner
def reaches_in(x, half, period, image):
    """Whether an image, -1, 0 or 1 periods away, of bounds around a wrapped place is required."""
    if image == 0:
        return True
    if period == 0.0:
        return False
    if image > 0:
        return x - half < 0.0
    return x + half > period


@inner
def periods_of(code):
    """Return how many periods an image is away along x, y and z, by its code from 0 to ALL."""
    return code % 3 - 1, code // 3 % 3 - 1, code // 9 - 1


def make_sort_images(spec: Spec) -> Any:
    """Return `kernel(bodies, work) -> leaves`: bodies and images with bounds, sorted for the tree.

    What is not periodic has one leaf each, as in `broad_phase.make_sort_leaves`.
    """
    has_leaf, complete_leaf = make_has_leaf(spec), make_complete_leaf(spec)

    def sort_images(bodies, work):
        fat_bounds, codes, order, leaves = work.fat_bounds, work.codes, work.order, work.leaves
        low_x, low_y, low_z = np.inf, np.inf, np.inf
        high_x, high_y, high_z = -np.inf, -np.inf, -np.inf
        largest, count = 0.0, 0
        for i in range(bodies.shape[0]):
            body, r = bodies[i], fat_bounds[i]
            if not has_leaf(body):
                continue
            x, y = wrapped(r.x, body.period_x), wrapped(r.y, body.period_y)
            z = wrapped(r.z, body.period_z)
            largest = max(largest, max(r.ex, max(r.ey, r.ez)))
            for code in range(ALL):
                kx, ky, kz = periods_of(code)
                if not reaches_in(x, r.ex, body.period_x, kx):
                    continue
                if not reaches_in(y, r.ey, body.period_y, ky):
                    continue
                if not reaches_in(z, r.ez, body.period_z, kz):
                    continue
                leaf = leaves[count]
                leaf.x = x + kx * body.period_x
                leaf.y = y + ky * body.period_y
                leaf.z = z + kz * body.period_z
                low_x, low_y, low_z = min(low_x, leaf.x), min(low_y, leaf.y), min(low_z, leaf.z)
                high_x, high_y = max(high_x, leaf.x), max(high_y, leaf.y)
                high_z = max(high_z, leaf.z)
                order[count] = i * ALL + code
                count += 1
        side = 1.0 / max(high_x - low_x, max(high_y - low_y, high_z - low_z))
        for k in range(count):
            leaf, r = leaves[k], fat_bounds[order[k] // ALL]
            x, y, z = leaf.x - low_x, leaf.y - low_y, leaf.z - low_z
            codes[k] = sort_code(x, y, z, side, r, largest)
        sort_by_code(codes, order, work.other_codes, work.other_order, work.counts, count)
        for k in range(count):
            i, code = order[k] // ALL, order[k] % ALL
            body, r, leaf = bodies[i], fat_bounds[i], leaves[k]
            kx, ky, kz = periods_of(code)
            leaf.x = wrapped(r.x, body.period_x) + kx * body.period_x
            leaf.y = wrapped(r.y, body.period_y) + ky * body.period_y
            leaf.z = wrapped(r.z, body.period_z) + kz * body.period_z
            complete_leaf(leaf, bodies, i, r)
        return count

    return kernel(sort_images, spec)
