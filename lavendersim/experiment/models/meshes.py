"""Surfaces of triangles as written: a mesh by its vertices, a height field by its heights."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field

from lavendersim.experiment.text.place import Place
from lavendersim.quantities.found import near
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Position, Quantity, Vector

MOST_TRIANGLES: Final = 1 << 17  # edges are counted in twenty bits of a contact's feature
MOST_VERTICES: Final = 3 * MOST_TRIANGLES
FILE: Final = "file"
TRIANGLES: Final = ("vertices", "triangles")  # instead of a file

Corner = Annotated[
    tuple[int, int, int], Vector(3, Quantity(whole=True, minimum=0, maximum=MOST_VERTICES))
]

HeightsAlongY = Annotated[
    tuple[Annotated[float, Quantity("m")], ...], Field(min_length=2, max_length=MOST_TRIANGLES)
]


class Mesh(ConfigModel):
    """A surface of triangles, touched from outside: where their corners run counter-clockwise."""

    kind: Literal["mesh"]
    vertices: tuple[Position, ...] | None = Field(
        default=None,
        min_length=3,
        max_length=MOST_VERTICES,
        description="[m] in the body's frame, whose origin is `position`; those at one place, to "
        "the last bit, are one",
    )
    triangles: tuple[Corner, ...] | None = Field(
        default=None,
        min_length=1,
        max_length=MOST_TRIANGLES,
        description="each by three rows of `vertices`, from 0, counter-clockwise seen from "
        "outside, that share whole sides. A body whose centre is behind one does not touch it",
    )
    file: str | None = Field(
        default=None,
        description="instead of both: a file *.obj or *.stl with them, from this file's folder",
    )
    scale: Annotated[float, Quantity(above=0)] = Field(
        default=1.0, description="[-] of all vertices; 1/1000 of a file in millimetres"
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """It has vertices and triangles; those of a file are here in its place by now."""
        if (mark := at.written(FILE)) is not None:
            where = "of a config's file, in scene.bodies or scene.shapes"
            sentence = f"{FILE}: expected it as the key of a mesh {where}; sweep its name"
            if (value := at.get(FILE).mark).file.startswith("--"):
                mark, why = value, "an option has no folder to look in"
                sentence = f"{FILE}: {why}; expected the name of a mesh of scene.shapes as `shape`"
            at.refuse(mark, sentence)
            return
        unknown = [key for key in at.node.entries if key not in cls.model_fields]
        for key, meaning in _NEEDED.items():
            if at.written(key) is None:
                if at.node.incomplete or any(near(one, cls.model_fields) == key for one in unknown):
                    at.doubt()  # a refused key may have been this one
                else:
                    at.lacks(key, meaning)


_NEEDED: Final = {
    "vertices": "[m] a list of [x, y, z], or a file: part.stl",
    "triangles": "a list of [row, row, row] of vertices, or a file: part.stl",
}


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
