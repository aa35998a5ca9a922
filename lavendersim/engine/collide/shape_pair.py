"""What an engine knows of a pair of shapes: its name, the two shapes in order, its manifold kernel.

A pair is one file in `pairs`, and a `ShapePair` in `pairs.DECLARED`. Convex shapes that no file has
together go by GJK and EPA (`pairs/convex.py`).
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, NamedTuple

from ..spec import Spec


class ShapePair(NamedTuple):
    """A pair of shapes that can touch; to declare it loads no kernel."""

    name: str
    shapes: tuple[str, str]
    file: str  # of `pairs`, whose `make(spec)` returns its kernel
    # Whether its points hold the true distance at any margin: the time of impact then needs no GJK.
    closed_form: bool = False
    # Whether each of its points has a normal of its own (`manifold.own_normals`).
    own_normals: bool = False
    inside: bool = False  # whether B is inside of A, whose wall curves towards it
    kind: int = -1  # number of the pair in PAIR.kind: its place among those declared

    @property
    def convex(self) -> bool:
        """Whether both shapes are bounded and convex."""
        return "plane" not in self.shapes and not self.own_normals

    def make(self, spec: Spec) -> Any:
        """Return the kernel that writes the manifold of A, of the first shape, and B."""
        return import_module(f".pairs.{self.file}", __package__).make(spec)


def numbered(*declared: ShapePair) -> dict[str, ShapePair]:
    """Return the pairs by name, each with its number."""
    pairs = {pair.name: pair._replace(kind=kind) for kind, pair in enumerate(declared)}
    assert len(pairs) == len({pair.shapes for pair in declared}) == len(declared)
    return pairs
