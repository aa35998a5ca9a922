"""The rows of the engine's body table, described: bodies, and the parts of compounds.

Row k is body k; the parts of compounds follow behind all bodies, each with the row of its owner. A
compound's own row moves and has no surface; its parts have surfaces and do not move by themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from lavendersim.cell import (
    CellBody,
    CellCompound,
    CellPart,
    CellShape,
)


class Collider(NamedTuple):
    """One row of the body table: a body, or a part of one."""

    shape: CellShape
    body: CellBody  # the body it belongs to
    owner: int  # row of that body; its own row where it is no part
    part: CellPart | None = None  # of its compound, with its place in it

    @property
    def kind(self) -> str:
        """Name of the shape."""
        return self.shape.kind


def colliders(bodies: Sequence[CellBody]) -> list[Collider]:
    """Return a description of every row of the body table."""
    rows = [Collider(body.shape, body, row) for row, body in enumerate(bodies)]
    for row, body in enumerate(bodies):
        rows.extend(Collider(part.shape, body, row, part) for part in parts_of(body.shape))
    return rows


def parts_of(shape: CellShape) -> tuple[CellPart, ...]:
    """Return the parts of a compound; none of any other shape."""
    return shape.parts if isinstance(shape, CellCompound) else ()
