"""Restitution that is captured as a contact is made, of contacts that are made ahead of touching.

With `impacts: captured` a contact rebounds by the speed at which it began, at the end of its step.
With `speculative`, the default, it begins ahead, where it may close just so far that it touches:
the rebound acts on what is left, and a bounce with e = 1 keeps a share of its energy that depends
on where in a step it comes. Who writes `speculative` says that it is meant.
"""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.errors import Defect
from lavendersim.experiment import Cell, described, key_mark
from lavendersim.experiment.text.node import UNWRITTEN

from .one_sided import surface_of


def captured_ahead(cell: Cell) -> Iterator[Defect]:
    """Yield a defect at `impacts: captured` where surfaces rebound and contacts are made ahead."""
    tree = cell.tree
    numerics = tree.get("numerics")
    ahead = numerics.get("speculative")
    if numerics.get("impacts").text != "captured" or not ahead.content or ahead.mark != UNWRITTEN:
        return
    pairs = tree.get("scene", "surface_pairs").entries.values()
    surfaces = [surface_of(tree, body) for _, body in described(tree)]
    if any(one.get("restitution").number for one in (*surfaces, *pairs)):
        sentence = (
            "captured impacts of contacts that are made ahead of touching (speculative, the"
            " default) lose energy by where in a step they come, whatever their restitution:"
            " expected speculative: false beside them, or impacts: in_order"
        )
        yield key_mark(numerics, "impacts").defect(cell.file, sentence)
