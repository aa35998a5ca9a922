"""Classes of rows of the body table that touch others alike, and what holds between two of them.

Ten thousand equal spheres are one class: what holds for a pair of rows is worked out once for a
pair of classes.
"""

from __future__ import annotations

import collections
from collections.abc import Sequence
from typing import Any, NamedTuple

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import SURFACE_KEYS

from .colliders import Collider, is_movable

_PAIR_BY_SHAPES = {pair.shapes: name for name, pair in SHAPE_PAIRS.items()}


_Declared: Any = getattr(collections, "namedtuple")(  # noqa: B009 - mypy reads it otherwise
    "_Declared",
    [key.name for key in SURFACE_KEYS],
    defaults=[key.default for key in SURFACE_KEYS],
)


class Surface(_Declared):  # type: ignore[misc]  # its fields are known when it is composed
    """The properties of a surface, or of a pair of surfaces once mixed: the keys of effects."""

    __slots__ = ()


class RowClass(NamedTuple):
    """What rows must have in common to touch others alike."""

    kind: str
    surface: Surface
    movable: bool

    def touches(self, other: RowClass) -> bool:
        """Whether rows of the two classes may touch: one of them moves, both have a surface."""
        return (self.movable or other.movable) and "compound" not in (self.kind, other.kind)


class ClassPair(NamedTuple):
    """Two classes with rows that may touch, and the first such rows.

    `a` and `b` are in the order that the kernel of the shape pair takes them.
    """

    a: int
    b: int
    shape_pair: str
    surface: Surface
    row_pairs: int  # how many


def mix(one: Surface, other: Surface) -> Surface:
    """Return what holds between two surfaces, each property as its effect mixes it."""
    return Surface(*(key.mix(a, b) for key, a, b in zip(SURFACE_KEYS, one, other, strict=True)))


def class_of(row: Collider) -> RowClass:
    """Return the class of one row."""
    surface = row.body.surface
    mixed = Surface(*(getattr(surface, name) for name in Surface._fields))
    return RowClass(row.kind, mixed, is_movable(row.body))


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


def class_pairs(rows: Sequence[Collider]) -> list[ClassPair]:
    """Return every pair of classes of which rows may touch, in the order of their first rows.

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
    found = []
    for i, one in enumerate(classes):
        for j in range(i, len(classes)):
            other = classes[j]
            pairs = [(a, b) for a in first[i] for b in first[j] if rows[a].owner != rows[b].owner]
            if not pairs or not one.touches(other):
                continue
            count = sizes[i] * (sizes[i] - 1) // 2 if i == j else sizes[i] * sizes[j]
            a, b = min(pairs, key=sorted)
            swap, name = ordered((rows[a].kind, rows[b].kind))
            if swap:
                a, b = b, a
            found.append(ClassPair(a, b, name, mix(one.surface, other.surface), count))
    return sorted(found, key=lambda pair: sorted((pair.a, pair.b)))
