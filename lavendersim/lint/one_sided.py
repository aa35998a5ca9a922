"""Friction that one surface of a pair specifies and the other does not, so that there is none.

A pair takes the geometric mean of its two surfaces' coefficients: with one that nobody specified,
which is 0, the other is without effect. A surface with `friction: 0` says that it is meant, and so
does a pair of `surface_pairs` that has the coefficient.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from lavendersim.engine.effects import SURFACE_KEYS
from lavendersim.errors import Defect
from lavendersim.experiment import Cell, Mark, Node, described, immovable, key_mark
from lavendersim.experiment.models.surface_pairs import between

# Coefficients of which a 0 makes 0, but for those that need another one, which says it for both.
MEANS: Final = tuple(key.name for key in SURFACE_KEYS if key.mix(1.0, 0.0) == 0.0 and not key.needs)
MOST_NAMES: Final = 3


def one_sided(cell: Cell) -> Iterator[Defect]:
    """Yield a defect at each coefficient that some body it may touch makes 0 by leaving it out."""
    tree = cell.tree
    surfaces = {name: surface_of(tree, body) for name, body in described(tree)}
    named = {name: body.get("surface").text for name, body in described(tree)}
    moves = {name: immovable(body, prescribed=True) is None for name, body in described(tree)}
    for key in MEANS:
        written = _written(tree, key)
        without = [name for name, surface in surfaces.items() if key not in surface.entries]
        against: dict[Mark, tuple[Node, str, list[str]]] = {}
        for name, surface in surfaces.items():
            value = surface.get(key)
            if not value.number:
                continue
            mark = key_mark(surface, key)
            _, _, others = against.setdefault(mark, (value, name, []))
            others += [
                one
                for one in without
                if (moves[one] or moves[name])
                and frozenset((named[one], named[name])) not in written
            ]
        for mark, (value, name, others) in against.items():
            if not others:
                continue
            listed = _listed(list(dict.fromkeys(others)))
            verb = "specify" if len(set(others)) > 1 else "specifies"
            sentence = (
                f"{key}: {value.number:g} of {name} has no effect where it touches {listed}, which "
                f"{verb} none: a pair takes the geometric mean, 0; specify it there, or {key}: 0"
            )
            yield mark.defect(cell.file, sentence)


def _written(tree: Node, key: str) -> set[frozenset[str | None]]:
    """Return the surfaces of each pair that has the coefficient; two alike are one name."""
    pairs = tree.get("scene", "surface_pairs").entries.values()
    return {frozenset(between(pair)) for pair in pairs if pair.get(key).number is not None}


def surface_of(tree: Node, body: Node) -> Node:
    """Return the surface that a body has, its own or one by name."""
    surface = body.get("surface")
    return surface if surface.text is None else tree.get("scene", "surfaces", surface.text)


def _listed(names: list[str]) -> str:
    shown, more = names[:MOST_NAMES], len(names) - MOST_NAMES
    if more > 0:
        return f"{', '.join(shown)} and {more} more"
    return " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1])))
