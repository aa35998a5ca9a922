"""The first body of an arrangement: `first` over `body`, key by key."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from lavendersim.experiment.models.tree import ARRANGEMENTS, PRESCRIBE_MOTION
from lavendersim.experiment.text.node import Node, graft

# What a key of `first` takes the place of, beside the same key of `body`.
_MASSES: Final = ("mass", "density", "inertia")
_WITHOUT_MASS: Final = ("fixed", *PRESCRIBE_MOTION)


def with_first_members(root: Node) -> Node:
    """Return the tree with what `first` leaves out taken from its `body`."""
    for name, arrangement in root.get(*ARRANGEMENTS).entries.items():
        first, body = arrangement.get("first"), arrangement.get("body")
        if not first.entries or not body.entries:
            continue
        rest = {key: node for key, node in body.entries.items() if not _replaced(key, first)}
        keys = {key: mark for key, mark in body.keys.items() if key in rest} | dict(first.keys)
        whole = replace(first, content=rest | first.entries, keys=keys)
        root = graft(root, (*ARRANGEMENTS, name, "first"), whole)
    return root


def _replaced(key: str, first: Node) -> bool:
    if any(first.get(own).is_true for own in _WITHOUT_MASS):
        return key in _MASSES
    return key in _MASSES and any(mass in first.entries for mass in ("mass", "density"))
