"""Surfaces of triangles as written: a mesh by its vertices, a height field by its heights."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Position, Quantity, Vector

MOST_TRIANGLES: Final = 1 << 17  # edges are counted in twenty bits of a contact's feature
MOST_VERTICES: Final = 3 * MOST_TRIANGLES

Corner = Annotated[
    tuple[int, int, int], Vector(3, Quantity(whole=True, minimum=0, maximum=MOST_VERTICES))
]

HeightsAlongY = Annotated[
    tuple[Annotated[float, Quantity("m")], ...], Field(min_length=2, max_length=MOST_TRIANGLES)
]


class Mesh(ConfigModel):
    """A surface of triangles, touched from outside: where their corners run counter-clockwise."""

    kind: Literal["mesh"]
    vertices: tuple[Position, ...] = Field(
        min_length=3,
        max_length=MOST_VERTICES,
        description="[m] in the body's frame, whose origin is `position`; those at one place, to "
        "the last bit, are one",
    )
    triangles: tuple[Corner, ...] = Field(
        min_length=1,
        max_length=MOST_TRIANGLES,
        description="each by three rows of `vertices`, from 0, counter-clockwise seen from "
        "outside, that share whole sides. A body whose centre is behind one does not touch it",
    )


class HeightField(ConfigModel):
    """A ground over a grid: two triangles a cell, the outside is at +z."""

    kind: Literal["height_field"]
    heights: tuple[HeightsAlongY, ...] = Field(
        min_length=2,
        max_length=MOST_TRIANGLES,
        description="[m] along the body's z: a row for each x, in it one for each y; the grid's "
        "middle is the body's origin. The diagonal of a cell leads from its row and height i, j to "
        "i + 1, j + 1 where i + j is even, else from i + 1, j to i, j + 1. A body whose centre is "
        "below does not touch it",
    )
    spacing: Annotated[tuple[float, float], Vector(2, Quantity("m", above=0))] = Field(
        description="[m] between two rows along x, and between two heights along y"
    )
