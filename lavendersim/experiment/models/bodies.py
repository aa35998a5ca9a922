"""The bodies of a config as written: surface, mass, start and motion; one by one or arranged."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, Tag

from lavendersim.cell.body import Drag, Release
from lavendersim.cell.surface import Surface
from lavendersim.experiment.models.shapes import Orientation, Shape, Solid
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import SurfaceName
from lavendersim.quantities.quantity import (
    AngularVelocity,
    Position,
    Quantity,
    Vector,
    Vector3,
    Velocity,
    either,
)

STATIC_HINT = "a body that never moves has fixed: true"


def _surface_form(value: Any) -> str | None:
    forms: dict[type, str] = {str: "name", dict: "properties"}
    return forms.get(type(value))


SurfaceOf = Annotated[
    Annotated[SurfaceName, Tag("name")] | Annotated[Surface, Tag("properties")],
    either("the name of a surface or {restitution: ..., friction: ...}", _surface_form),
]


class _Matter(ConfigModel):
    """What bodies have in common, whether they stand alone or are arranged."""

    mass: Annotated[float, Quantity("kg", above=0, hint=STATIC_HINT)] | None = Field(
        default=None, description="[kg]"
    )
    density: Annotated[float, Quantity("kg/m^3", above=0)] | None = Field(
        default=None, description="[kg/m^3]"
    )
    inertia: Annotated[Vector3, Vector(3, Quantity("kg m^2", above=0))] | None = Field(
        default=None,
        description="[kg m^2] moments about the body's x, y, z; not stated: of a homogeneous solid",
    )
    fixed: bool = Field(default=False, description="true: never moves, has no mass")
    kinematic: bool = Field(
        default=False,
        description="true: keeps its velocity and angular velocity whatever touches it, no mass",
    )
    surface: SurfaceOf = Field(
        default=Surface(), description="name of one of scene.surfaces, or its properties in place"
    )
    surface_velocity: Velocity = Field(
        default=(0.0, 0.0, 0.0),
        description="[m/s] of the surface in the body's frame, added in contacts: conveyors",
    )
    orientation: Orientation = Field(
        default=(1.0, 0.0, 0.0, 0.0),
        description="quaternion w x y z, or axis and degrees; is normalised",
    )
    velocity: Velocity = Field(default=(0.0, 0.0, 0.0), description="[m/s] of the centre of mass")
    angular_velocity: AngularVelocity = Field(
        default=(0.0, 0.0, 0.0), description="[rad/s] world frame, right-handed"
    )
    drag: Drag = Field(default=Drag(), description="resistance of the medium")


class Body(_Matter):
    """One rigid body. Planes are static; a movable body has exactly one of mass and density."""

    shape: Shape = Field(description="plane, sphere, box, capsule, cylinder, hull or compound")
    position: Position | None = Field(default=None, description="[m] centre of mass, world frame")
    release: Release | None = Field(
        default=None, description="start above a plane, instead of position"
    )


class ArrangedBody(_Matter):
    """A body that stands in several places: all that a body has but its position."""

    shape: Annotated[Solid, Field(discriminator="kind")] = Field(
        description="sphere, box, capsule, cylinder, hull or compound"
    )
