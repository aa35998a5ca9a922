"""The bodies of a config as written: surface, mass, start and motion; one by one or arranged."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Any

from pydantic import Field, Tag

from lavendersim.experiment.base import ConfigModel
from lavendersim.experiment.names import PlaneName, SurfaceName
from lavendersim.experiment.quantities import (
    AngularVelocity,
    Position,
    Quantity,
    Vector,
    Vector3,
    Velocity,
    either,
)
from lavendersim.experiment.shape_models import Orientation, Shape, Solid

STATIC_HINT = "a body that never moves has fixed: true"


class Surface(ConfigModel):
    """What a body's surface does in a contact; a property that is not stated is 0.

    In a contact of two surfaces friction is the geometric mean sqrt(mu_a mu_b), so that a smooth
    surface stays smooth; compliances add (two springs in series); restitution, torsional and
    rolling friction are the larger of the two.
    """

    restitution: Annotated[float, Quantity(minimum=0, maximum=1)] = Field(
        default=0.0,
        description="share of the approach speed given back, 0 to 1; a pair takes the larger",
    )
    compliance: Annotated[float, Quantity("m/N", minimum=0)] = Field(
        default=0.0, description="[m/N] indentation per force; the two surfaces of a contact add"
    )
    friction: Annotated[float, Quantity(minimum=0)] = Field(
        default=0.0,
        description="Coulomb coefficient mu; a pair takes the geometric mean sqrt(mu_a mu_b)",
    )
    torsional_friction: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.0,
        description="[m] torque about the normal per normal force; a pair takes the larger",
    )
    rolling_friction: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.0,
        description="[m] torque against rolling per normal force; a pair takes the larger",
    )


class Release(ConfigModel):
    """A start above a plane, by the clearance of the surfaces instead of a position."""

    above: PlaneName = Field(description="name of the plane below")
    clearance: Annotated[float, Quantity("m", minimum=0)] = Field(
        description="[m] gap between the body's surface and the plane along the plane's normal"
    )
    phase: Annotated[Fraction, Quantity(minimum=0, exact=True)] = Field(
        default=Fraction(0),
        description="share of the fall of one step at impact, sqrt(2 g h) dt, added to the gap",
    )
    at: Annotated[tuple[float, float], Vector(2, Quantity("m"))] | None = Field(
        default=None,
        description="[m] x and y of the centre; not stated: on the plane's normal through 0",
    )


class Drag(ConfigModel):
    """What the medium does: force -(linear + quadratic |v|) v, torque -angular omega."""

    linear: Annotated[float, Quantity("N s/m", minimum=0)] = Field(
        default=0.0, description="[N s/m] force per speed"
    )
    quadratic: Annotated[float, Quantity("N s^2/m^2", minimum=0)] = Field(
        default=0.0, description="[N s^2/m^2] force per speed squared"
    )
    angular: Annotated[float, Quantity("N m s", minimum=0)] = Field(
        default=0.0, description="[N m s] torque per angular velocity"
    )


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
