"""Events of a cell: changes to a body or of the timestep, before the first step from a time on."""

from __future__ import annotations

from typing import Literal

from lavendersim.cell.numerics import Timestep
from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import Vector3


class CellEvent(ResolvedModel):
    """One change to a body, applied before the first step that starts at `at` or later."""

    at: float  # [s]
    body: str
    scale_mass: float | None
    teleport: Vector3 | None  # [m]
    velocity: Vector3 | None  # [m/s]
    angular_velocity: Vector3 | None  # [rad/s]
    contact_cache: Literal["keep", "clear"]
    remove: bool  # and nothing else happens to it


class CellTimestep(ResolvedModel):
    """A timestep that applies from the first step that starts at `at` or later."""

    at: float  # [s]
    timestep: Timestep  # [s]
