"""Pairs of boxes along the world's axes that meet: sweep and prune, or a grid of cells.

Sweep and prune (Baraff 1992): sorted by their lower ends along an axis, a box can meet only those
whose lower end comes before its own upper end. In a deep heap these are whole layers, n^(2/3) boxes
each. There boxes are sorted into cells as large as the largest of them, and meet only those of the
27 cells around; boxes much larger than the others are compared with all.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Final

import numpy as np

from lavendersim.geometry.rotations import Floats

Rows = np.ndarray  # of boxes

MOST_SWEPT: Final = 40  # candidates a box, of sweep and prune: a grid has some 14 and costs more
LARGE: Final = 4.0  # times the extent that half of the boxes have
MOST_CELLS: Final = 2.0**40  # along an axis, so that a float tells a cell from its neighbour
AHEAD: Final = [step for step in product((-1, 0, 1), repeat=3) if step > (0, 0, 0)]


def meeting_boxes(low: Floats, high: Floats) -> tuple[Rows, Rows]:
    """Return the two rows of every pair of boxes that meet or touch, each pair once.

    low, high: (n, 3) least and largest coordinates [m]; infinite ones are none of a grid's.
    """
    known = np.isfinite(high - low).all(axis=1)
    centre = 0.5 * (low[known] + high[known])
    axis = int(np.argmax(np.ptp(centre, axis=0))) if len(centre) else 0
    order = np.argsort(low[:, axis], kind="stable")
    ends = np.searchsorted(low[order, axis], high[order, axis], side="right")
    counts = ends - np.arange(len(order)) - 1
    if counts.sum() > MOST_SWEPT * len(low) and (found := _by_cells(low, high)) is not None:
        return found
    first, second = _runs(np.arange(1, len(order) + 1), counts)
    return _meeting(low, high, order[first], order[second])


def _by_cells(low: Floats, high: Floats) -> tuple[Rows, Rows] | None:
    """Return the pairs that meet by a grid of cells; None where the boxes fit none."""
    size = (high - low).max(axis=1)
    is_small = size <= LARGE * np.median(size)
    small, large = np.flatnonzero(is_small), np.flatnonzero(~is_small)
    edge = float(size[small].max(initial=0.0))
    if not 0.0 < edge < np.inf:
        return None
    centre = 0.5 * (low[small] + high[small])
    cells = np.floor((centre - centre.min(axis=0)) / edge)
    if not cells.max() < MOST_CELLS:
        return None
    pairs = [_meeting(low, high, small[a], small[b]) for a, b in _neighbours(cells)]
    rows = np.arange(len(low))
    for row in large:  # with all that are small, and the large ones behind it
        others = rows[is_small | (rows > row)]
        pairs.append(_meeting(low, high, np.full(len(others), row), others))
    first, second = zip(*pairs, strict=True)
    return np.concatenate(first), np.concatenate(second)


def _neighbours(cells: Floats) -> Iterator[tuple[Rows, Rows]]:
    """Yield rows of pairs in one cell, then in neighbouring ones, direction by direction.

    cells: (n, 3) whole numbers. Cells are called by their ranks along each axis, as one number.
    """
    along = [np.unique(column) for column in cells.T]
    order = np.lexsort(cells.T[::-1])
    cells = cells[order]
    name = _names(cells, along)[0]
    ends = np.searchsorted(name, name, side="right")
    begins = np.arange(1, len(name) + 1)
    first, second = _runs(begins, ends - begins)
    yield order[first], order[second]
    for step in AHEAD:
        wanted, there = _names(cells + step, along)
        begins = np.searchsorted(name, wanted, side="left")
        counts = np.searchsorted(name, wanted, side="right") - begins
        first, second = _runs(begins, np.where(there, counts, 0))
        yield order[first], order[second]


def _names(cells: Floats, along: list[Floats]) -> tuple[Rows, Rows]:
    """Return one number for each cell, rising as cells do, and whether there is such a cell."""
    name, there = np.zeros(len(cells), dtype=np.int64), np.ones(len(cells), dtype=bool)
    for column, values in zip(cells.T, along, strict=True):
        rank = np.searchsorted(values, column)
        there &= (rank < len(values)) & (values[np.minimum(rank, len(values) - 1)] == column)
        name = name * len(values) + rank
    return name, there


def _runs(begins: Rows, counts: Rows) -> tuple[Rows, Rows]:
    """Return each row as often as it has candidates, and these: `counts` from `begins` on."""
    first = np.repeat(np.arange(len(counts)), counts)
    step = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    return first, begins[first] + step


def _meeting(low: Floats, high: Floats, a: Rows, b: Rows) -> tuple[Rows, Rows]:
    meet = np.all((low[a] <= high[b]) & (low[b] <= high[a]), axis=1)
    return a[meet], b[meet]
