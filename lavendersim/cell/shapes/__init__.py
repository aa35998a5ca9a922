"""Shapes of bodies: half-space, cavities, meshes, convex solids, compounds of these. One file each.

Each has a frame of its own. The frame of a body has its origin in the centre of mass and its axes
along the principal axes of the shape; corners of hulls and parts of compounds are given in it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Union

from pydantic import Field

from lavendersim.cell.shapes.box import Box
from lavendersim.cell.shapes.capsule import Capsule
from lavendersim.cell.shapes.cavity import Bowl, Cavity, Drum
from lavendersim.cell.shapes.compound import CellCompound, CellPart
from lavendersim.cell.shapes.cone import Cone
from lavendersim.cell.shapes.convex import PRIMITIVES, CellSimple
from lavendersim.cell.shapes.cylinder import Cylinder
from lavendersim.cell.shapes.ellipsoid import Ellipsoid
from lavendersim.cell.shapes.hull import CellHull
from lavendersim.cell.shapes.mesh import CellMesh
from lavendersim.cell.shapes.plane import Plane
from lavendersim.cell.shapes.shape import Convex, Homogeneous, Primitive
from lavendersim.cell.shapes.sphere import Sphere

if TYPE_CHECKING:
    CellShape = Plane | Cavity | CellMesh | Convex | CellCompound
else:
    CellShape = Annotated[
        Union[(Plane, *PRIMITIVES, CellHull, CellCompound, Bowl, Drum, CellMesh)],
        Field(discriminator="kind"),
    ]

__all__ = [
    "PRIMITIVES",
    "Bowl",
    "Box",
    "Capsule",
    "Cavity",
    "CellCompound",
    "CellHull",
    "CellMesh",
    "CellPart",
    "CellShape",
    "CellSimple",
    "Cone",
    "Convex",
    "Cylinder",
    "Drum",
    "Ellipsoid",
    "Homogeneous",
    "Plane",
    "Primitive",
    "Sphere",
]
