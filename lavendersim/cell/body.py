"""One body of a cell, ready to be built: shape, mass, inertia, surface, pose and motion."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated

from pydantic import Field

from lavendersim.cell.shapes import CellShape
from lavendersim.cell.surface import PairedSurface, Surface
from lavendersim.engine.effects import BODY_KEYS, MOTION_KEYS
from lavendersim.quantities.model import ConfigModel, ResolvedModel, declared
from lavendersim.quantities.names import PlaneName
from lavendersim.quantities.quantity import Quantity, Quaternion, Vector, Vector3


class Release(ConfigModel):
    """A start above a plane, by the clearance of the surfaces instead of a position."""

    above: PlaneName = Field(description="name of the plane below")
    clearance: Annotated[float, Quantity("m", minimum=0)] = Field(
        description="[m] gap between the body's surface and the plane along the plane's normal"
    )
    phase: Annotated[Fraction, Quantity(minimum=0, exact=True)] = Field(
        default=Fraction(0),
        description="adds phase * sqrt(2 g h) * timestep to the gap h: where in a step the impact "
        "falls",
    )
    at: Annotated[tuple[float, float], Vector(2, Quantity("m"))] | None = Field(
        default=None,
        description="[m] x and y of the centre; none: on the plane's normal through 0",
    )


class Constrained(ResolvedModel):
    """What a body is, and whether contacts and forces move it."""

    shape: CellShape
    fixed: bool  # they do not: a plane, a fixed body, one whose motion a key prescribes


class BodyOwn(declared("BodyOwn", Constrained, MOTION_KEYS), Constrained):  # type: ignore[misc]
    """What a body has whatever effects there are, behind the keys that prescribe its motion."""

    mass: float | None  # [kg]; None where `fixed`
    density: float | None  # [kg/m^3] as written
    inertia: Vector3 | None  # [kg m^2] about the axes of its frame; None where `fixed`
    surface: PairedSurface | Surface
    position: Vector3  # [m] centre of mass; of a plane: its point nearest to the origin
    release: Release | None  # as written; `position` follows from it
    orientation: Quaternion  # unit quaternion w x y z, its frame to world
    velocity: Vector3  # [m/s]
    angular_velocity: Vector3  # [rad/s]


class CellBody(declared("CellBody", BodyOwn, BODY_KEYS), BodyOwn):  # type: ignore[misc]
    """One rigid body; its frame has the centre of mass as origin and the principal axes.

    Behind what every body has stand the keys that effects declare.
    """
