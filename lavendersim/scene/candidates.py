"""Every pair of rows of the body table that may touch, listed one by one: for small scenes."""

from __future__ import annotations

from collections.abc import Sequence

from lavendersim.cell import CellBody
from lavendersim.cell.mixing import mixed
from lavendersim.engine.effects import PairFacts

from .classes import class_of, ordered
from .colliders import colliders


def candidate_pairs(bodies: Sequence[CellBody]) -> list[PairFacts[int]]:
    """Return every pair of rows of which one moves, in the order of the rows; for small scenes."""
    rows = colliders(bodies)
    classes = [class_of(row) for row in rows]
    pairs = []
    for i, one in enumerate(classes):
        for j in range(i + 1, len(classes)):
            other = classes[j]
            if rows[i].owner == rows[j].owner or not one.touches(other):
                continue
            swap, name = ordered((one.kind, other.kind))
            a, b = (j, i) if swap else (i, j)
            pairs.append(PairFacts(a, b, mixed(one.surface, other.surface), name))
    return pairs
