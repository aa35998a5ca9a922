"""The scene of a cell: gravity, bodies in the order of their rows, forces over time."""

from __future__ import annotations

from pydantic import Field

from lavendersim.cell.body import CellBody
from lavendersim.engine.effects import SCENE_KEYS
from lavendersim.quantities.model import ResolvedModel, declared
from lavendersim.quantities.quantity import Vector3


class CellForce(ResolvedModel):
    """A force and a torque on one body, constant for a while."""

    body: str
    begin: float = Field(alias="from")  # [s]
    end: float = Field(alias="to")  # [s]
    force: Vector3  # [N] world frame
    torque: Vector3  # [N m] world frame


class CellScene(declared("CellScene", ResolvedModel, SCENE_KEYS)):  # type: ignore[misc]
    """Gravity, the bodies in the order of the file, then those arranged, and the forces."""

    gravity: Vector3  # [m/s^2]
    bodies: dict[str, CellBody]
    forces: tuple[CellForce, ...]
