"""Classes of rows of the body table that touch others alike, and what holds between two of them.

Ten thousand equal spheres are one class: what holds for a pair of rows is worked out once for a
pair of classes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from lavendersim.cell import Surface
from lavendersim.cell.mixing import mixed
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import PairFacts
from lavendersim.geometry.bodies import is_movable

from .colliders import Collider

_PAIR_BY_SHAPES = {pair.shapes: name for name, pair in SHAPE_PAIRS.items()}


# Pairs of bodies that do not touch since a joint joins them, each by its rows in order.
Joined = frozenset[tuple[int, int]]
NOTHING_JOINED: Joined = frozenset()


class RowClass(NamedTuple):
    """What rows must have in common to touch others alike."""

    kind: str
    surface: Surface
    movable: bool

    def touches(self, other: RowClass) -> bool:
        """Whether rows of the two classes may touch: one of them moves, both have a surface."""
        return (self.movable or other.movable) and "compound" not in (self.kind, other.kind)


def class_of(row: Collider) -> RowClass:
    """Return the class of one row."""
    return RowClass(row.kind, row.body.surface, is_movable(row.body))


def classes_of(rows: Sequence[Collider]) -> tuple[list[RowClass], list[int]]:
    """Return the classes in the order of their first rows, and the class of every row."""
    numbers: dict[RowClass, int] = {}
    members = [numbers.setdefault(class_of(row), len(numbers)) for row in rows]
    return list(numbers), members


def ordered(kinds: tuple[str, str]) -> tuple[bool, str]:
    """Return whether the two shapes must change places, and the name of their pair."""
    if kinds in _PAIR_BY_SHAPES:
        return False, _PAIR_BY_SHAPES[kinds]
    return True, _PAIR_BY_SHAPES[kinds[1], kinds[0]]


def is_joined(rows: Sequence[Collider], a: int, b: int, joined: Joined) -> bool:
    """Whether a joint keeps the bodies of two rows from touching."""
    one, other = rows[a].owner, rows[b].owner
    return (min(one, other), max(one, other)) in joined


def _count_joined(
    rows: Sequence[Collider], members: Sequence[int], joined: Joined
) -> Counter[tuple[int, int]]:
    """Return how many pairs of rows of two classes do not touch since they are joined."""
    of_body: dict[int, list[int]] = {}
    for row, number in enumerate(members):
        of_body.setdefault(rows[row].owner, []).append(number)
    return Counter(
        (min(one, other), max(one, other))
        for a, b in joined
        for one in of_body[a]
        for other in of_body[b]
    )


def class_pairs(rows: Sequence[Collider], joined: Joined = NOTHING_JOINED) -> list[PairFacts[int]]:
    """Return every pair of classes of which rows may touch, in the order of their first rows.

    Each under the first two rows, in the order that the kernel of their shape pair takes them.
    Parts of one body do not touch each other; `row_pairs` counts theirs too.
    """
    classes, members = classes_of(rows)
    first: list[list[int]] = [[] for _ in classes]  # of each class: the first rows of two owners
    sizes = [0] * len(classes)
    for row, number in enumerate(members):
        sizes[number] += 1
        known = first[number]
        if not known or (len(known) == 1 and rows[known[0]].owner != rows[row].owner):
            known.append(row)
    apart = _count_joined(rows, members, joined)
    found = []
    for i, one in enumerate(classes):
        for j in range(i, len(classes)):
            other = classes[j]
            pairs = [(a, b) for a in first[i] for b in first[j] if rows[a].owner != rows[b].owner]
            if not pairs or not one.touches(other):
                continue
            count = sizes[i] * (sizes[i] - 1) // 2 if i == j else sizes[i] * sizes[j]
            count -= apart[i, j]
            if count == 0:
                continue
            # Named by two that touch, where the first of the classes are such.
            free = [pair for pair in pairs if not is_joined(rows, *pair, joined)]
            a, b = min(free or pairs, key=sorted)
            swap, name = ordered((rows[a].kind, rows[b].kind))
            if swap:
                a, b = b, a
            found.append(PairFacts(a, b, mixed(one.surface, other.surface), name, count))
    return sorted(found, key=lambda pair: sorted((pair.a, pair.b)))
