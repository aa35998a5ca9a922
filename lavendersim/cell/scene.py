"""The scene of a cell: gravity, bodies in the order of their rows, forces over time."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lavendersim.cell.body import CellBody
from lavendersim.engine.effects import SCENE_KEYS, TimeFunction
from lavendersim.quantities.model import ResolvedModel, declared
from lavendersim.quantities.quantity import Vector3


class CellForce(ResolvedModel):
    """A force and a torque on one body, for a while."""

    body: str
    begin: float = Field(alias="from")  # [s]
    end: float = Field(alias="to")  # [s]
    force: Vector3  # [N]
    torque: Vector3  # [N m]
    factor: TimeFunction | None = None  # of both; None: 1
    point: Vector3 = (0.0, 0.0, 0.0)  # [m] in the body's frame: where the force acts
    frame: Literal["world", "body"] = "world"  # of both

    @property
    def constant_at_centre(self) -> bool:
        """Whether it is constant in world axes, and acts on the centre of mass."""
        return self.factor is None and self.frame == "world" and not any(self.point)


class CellScene(declared("CellScene", ResolvedModel, SCENE_KEYS)):  # type: ignore[misc]
    """Gravity, the bodies in the order of the file, then those arranged, and the forces."""

    gravity: Vector3  # [m/s^2]
    bodies: dict[str, CellBody]
    forces: tuple[CellForce, ...]
