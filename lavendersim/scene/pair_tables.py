"""The engine's table of pairs that may touch.

A small scene lists its pairs once. With the effect `broad_phase` the engine finds them itself: what
it writes into their rows is in `templates`, by the `material` of the two, the row of their class.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from lavendersim.cell import Surface
from lavendersim.cell.mixing import mixed
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.broad.broad_phase import template_dtype
from lavendersim.engine.effects import surface_fields
from lavendersim.engine.record_layout import allocate_pairs
from lavendersim.engine.removal import NO_PAIR
from lavendersim.engine.spec import Spec

from .candidates import candidate_pairs
from .classes import classes_of, ordered
from .colliders import Collider

# Rows of pairs that a scene with a broad phase starts with, per body: a densely packed pile of
# spheres has six, and the engine makes more when it needs them.
PAIRS_PER_BODY: Final = 8


def pair_tables(
    spec: Spec, rows: Sequence[Collider], bodies: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of pairs and the templates; fills `material` of bodies that have it."""
    if spec.has("broad_phase"):
        templates, bodies["material"] = _templates(spec, rows)
        return allocate_pairs(spec, PAIRS_PER_BODY * len(bodies)), templates
    candidates = candidate_pairs([row.body for row in rows if row.part is None])
    pairs = allocate_pairs(spec, len(candidates))
    names = _surface_names(pairs)
    for index, (line, pair) in enumerate(zip(pairs, candidates, strict=True)):
        line["a"], line["b"], line["key"] = pair.a, pair.b, index
        line["kind"] = SHAPE_PAIRS[pair.shape_pair].kind
        for name in names:
            line[name] = getattr(pair.surface, name)
    return pairs, np.zeros((0, 0), template_dtype([]))


def _surface_names(records: np.ndarray) -> list[str]:
    """Return the surface properties that records hold; absent effects have no column."""
    return [name for name in Surface.model_fields if name in (records.dtype.names or ())]


def _templates(spec: Spec, rows: Sequence[Collider]) -> tuple[np.ndarray, list[int]]:
    classes, members = classes_of(rows)
    templates = np.zeros((len(classes),) * 2, template_dtype(surface_fields(spec)))
    names = _surface_names(templates)
    templates["kind"] = NO_PAIR
    for i, one in enumerate(classes):
        for j, other in enumerate(classes):
            if not one.touches(other):
                continue
            swap, name = ordered((one.kind, other.kind))
            template, surface = templates[i, j], mixed(one.surface, other.surface)
            template["kind"], template["swap"] = SHAPE_PAIRS[name].kind, swap
            for field in names:
                template[field] = getattr(surface, field)
    return templates, members
