"""What an engine knows of a pair of shapes: its name, the two shapes in order, its manifold kernel.

A pair is one file in `pairs` that declares a `ShapePair`, and its name in `pairs.DECLARED`. Convex
shapes that no file has together go by GJK and EPA (`pairs/convex.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from ..spec import Spec


class ShapePair(NamedTuple):
    """A pair of shapes that can touch.

    make: `make(spec)` returns the kernel that writes the manifold of a body A of the first shape
    and a body B of the second.
    """

    name: str
    shapes: tuple[str, str]
    make: Callable[[Spec], Any]
    # Whether its points hold the true distance at any margin: the time of impact then needs no GJK.
    closed_form: bool = False
    kind: int = -1  # number of the pair in PAIR.kind: its place among those declared


def numbered(*declared: ShapePair) -> dict[str, ShapePair]:
    """Return the pairs by name, each with its number."""
    pairs = {pair.name: pair._replace(kind=kind) for kind, pair in enumerate(declared)}
    assert len(pairs) == len({pair.shapes for pair in declared}) == len(declared)
    return pairs
