"""Which cell of one run is compared with which of another: those at the same coordinates.

Where the sweeps have different axes, cells are paired by those that both have, as long as each side
has one cell there: a run without a sweep is compared with the one cell of another without a sweep.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from lavendersim.errors import UsageError
from lavendersim.measures.selection import coordinates_text
from lavendersim.runner import Run, RunCell


class CellPair(NamedTuple):
    """A cell of each run; label: the coordinates by which they are paired."""

    label: str
    a: RunCell
    b: RunCell


class Pairing(NamedTuple):
    """The pairs, and the labels of cells that have none."""

    axes: tuple[str, ...]  # by which cells are paired
    pairs: list[CellPair]
    only_a: list[str]
    only_b: list[str]


def paired(a: Sequence[RunCell], b: Sequence[RunCell]) -> Pairing:
    """Return the pairs of two runs, in the order of the first."""
    axes = [axis for axis in _axes(a) if axis in _axes(b)]
    mine, others = _by_coordinates(a, axes), _by_coordinates(b, axes)
    pairs = [
        CellPair(key, cells[0], others[key][0])
        for key, cells in mine.items()
        if len(cells) == 1 and len(others.get(key, ())) == 1
    ]
    found = {pair.label for pair in pairs}
    return Pairing(tuple(axes), pairs, _left(mine, found), _left(others, found))


def partner(a: Run, cell: RunCell, b: Run) -> int:
    """Return the place in `b` of the cell that one of `a` is compared with. UsageError without."""
    for pair in paired(a.cells, b.cells).pairs:
        if pair.a is cell:
            return b.cells.index(pair.b)
    label = cell.label or "the cell"
    raise UsageError(f"{b.path}: no one cell at the coordinates of {label} of {a.path}")


def _left(side: dict[str, list[RunCell]], found: set[str]) -> list[str]:
    """Return the labels of cells that were not paired."""
    left = [cell for key, cells in side.items() if key not in found for cell in cells]
    return [cell.label or "the cell" for cell in left]


def _axes(cells: Sequence[RunCell]) -> dict[str, None]:
    return {axis: None for cell in cells for axis in cell.coordinates}


def _by_coordinates(cells: Sequence[RunCell], axes: Sequence[str]) -> dict[str, list[RunCell]]:
    found: dict[str, list[RunCell]] = {}
    for cell in cells:
        there = [axis for axis in axes if axis in cell.coordinates]
        found.setdefault(coordinates_text(cell.coordinates, there), []).append(cell)
    return found
