"""The engine's table of pairs that may touch, and what an event does to the surface of a body.

A small scene lists its pairs once. With the effect `broad_phase` the engine finds them itself: what
it writes into their rows is in `templates`, by the `material` of the two, the row of their class.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

from lavendersim.cell import CellBody, Surface
from lavendersim.cell.mixing import mixed
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import has_hook, surface_fields
from lavendersim.engine.record_layout import allocate_pairs, template_dtype
from lavendersim.engine.records import NO_PAIR, ROPE
from lavendersim.engine.spec import Spec

from .candidates import candidate_pairs
from .classes import (
    NOTHING_JOINED,
    Joined,
    RowClass,
    class_of,
    classes_of,
    is_joined,
    ordered,
)
from .colliders import Collider, colliders

# Rows of pairs that a scene with a broad phase starts with, per body: a densely packed pile of
# spheres has six, and the engine makes more when it needs them.
PAIRS_PER_BODY: Final = 8


class PairTables(NamedTuple):
    """What the engine knows of pairs."""

    pairs: np.ndarray
    templates: np.ndarray  # (classes, classes); none without a broad phase
    classes: tuple[RowClass, ...]  # of the rows of `templates`


def pair_tables(
    spec: Spec,
    rows: Sequence[Collider],
    bodies: np.ndarray,
    later: Iterable[CellBody] = (),
    joined: Joined = NOTHING_JOINED,
) -> PairTables:
    """Return the rows of pairs and the templates; fills `material` of bodies that have it.

    later: bodies as events make them; their classes have templates, too. joined: pairs of bodies
    that do not touch; a broad phase knows them by the rows of joints.
    """
    if has_hook(spec, "find_pairs"):
        classes, bodies["material"][: len(rows)] = classes_of(rows)
        of_later = (class_of(row) for row in colliders(list(later)))
        every = tuple(dict.fromkeys([*classes, *of_later]))
        pairs = allocate_pairs(spec, PAIRS_PER_BODY * len(bodies))
        return PairTables(pairs, _templates(spec, every), every)
    candidates = [
        pair
        for pair in candidate_pairs([row.body for row in rows if row.part is None])
        if not is_joined(rows, pair.a, pair.b, joined)
    ]
    pairs = allocate_pairs(spec, len(candidates))
    for index, (line, pair) in enumerate(zip(pairs, candidates, strict=True)):
        line["a"], line["b"], line["key"] = pair.a, pair.b, index
        line["kind"] = SHAPE_PAIRS[pair.shape_pair].kind
        fill_surface(line, pair.surface)
    return PairTables(pairs, np.zeros((0, 0), template_dtype([])), ())


def list_materials(
    bodies: np.ndarray, rows: Sequence[Collider], classes: Sequence[RowClass], owner: int
) -> None:
    """Write the class of each row of one body, which has changed its surface."""
    for row, described in enumerate(rows):
        if described.owner == owner:
            bodies["material"][row] = classes.index(class_of(described))


def mix_again(pairs: np.ndarray, rows: Sequence[Collider], owner: int) -> None:
    """Mix the surfaces of all pairs of one body, which has changed its own, anew."""
    for line in pairs:
        if line["kind"] <= ROPE:  # it has no surface
            continue
        a, b = rows[line["a"]], rows[line["b"]]
        if owner in (a.owner, b.owner):
            fill_surface(line, mixed(a.body.surface, b.body.surface))


def fill_surface(record: np.void, surface: Surface) -> None:
    """Write the surface properties that a record holds; absent effects have no column."""
    for name in Surface.model_fields:
        if name in (record.dtype.names or ()):
            record[name] = getattr(surface, name)


def _templates(spec: Spec, classes: Sequence[RowClass]) -> np.ndarray:
    templates = np.zeros((len(classes),) * 2, template_dtype(surface_fields(spec)))
    templates["kind"] = NO_PAIR
    for i, one in enumerate(classes):
        for j, other in enumerate(classes):
            if not one.touches(other):
                continue
            swap, name = ordered((one.kind, other.kind))
            template = templates[i, j]
            template["kind"], template["swap"] = SHAPE_PAIRS[name].kind, swap
            fill_surface(template, mixed(one.surface, other.surface))
    return templates
