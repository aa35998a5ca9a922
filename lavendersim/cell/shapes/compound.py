"""Several convex solids that move as one body, in the principal frame of all."""

from __future__ import annotations

from typing import Literal

from lavendersim.cell.shapes.convex import CellSimple
from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import Quaternion, Vector3


class CellPart(ResolvedModel):
    """One convex piece of a compound, in the compound's principal frame."""

    shape: CellSimple
    position: Vector3  # [m] of its centre of mass
    orientation: Quaternion  # unit quaternion w x y z, part to compound


class CellCompound(ResolvedModel):
    """Several shapes that move as one body."""

    kind: Literal["compound"]
    parts: tuple[CellPart, ...]
    centre: Vector3  # [m] the centre of mass in the frame as written
    axes: Quaternion  # principal frame to frame as written
