"""The convex solids that a cell may have: one file each, and its name here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Final, Union

from pydantic import Field

from lavendersim.cell.shapes.box import Box
from lavendersim.cell.shapes.capsule import Capsule
from lavendersim.cell.shapes.cone import Cone
from lavendersim.cell.shapes.cylinder import Cylinder
from lavendersim.cell.shapes.ellipsoid import Ellipsoid
from lavendersim.cell.shapes.hull import CellHull
from lavendersim.cell.shapes.shape import Convex, Primitive
from lavendersim.cell.shapes.sphere import Sphere

# Those that a config gives by their dimensions; the order is that of messages.
PRIMITIVES: Final[tuple[type[Primitive], ...]] = (
    Sphere,
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    Cone,
)

if TYPE_CHECKING:
    CellSimple = Convex
else:
    CellSimple = Annotated[Union[(*PRIMITIVES, CellHull)], Field(discriminator="kind")]
