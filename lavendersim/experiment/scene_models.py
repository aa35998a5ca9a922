"""The `scene` of a config as written: gravity, named surfaces, shapes and bodies."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Any, Literal

from pydantic import Field, Tag

from lavendersim.experiment.base import ConfigModel
from lavendersim.experiment.names import NewName, PlaneName, SurfaceName
from lavendersim.experiment.quantities import (
    AngularVelocity,
    BoxSize,
    Direction,
    Position,
    Quantity,
    Vector,
    Vector3,
    Velocity,
    either,
)

GRAVITY = 9.81  # [m/s^2]
STATIC_HINT = "a body that never moves has fixed: true"


class Surface(ConfigModel):
    """What a body's surface does in a contact; a property that is not stated is 0.

    In a contact the restitution of the pair is the larger one, compliances add (two springs in
    series).
    """

    restitution: Annotated[float, Quantity(minimum=0, maximum=1)] = Field(
        default=0.0,
        description="share of the approach speed given back, 0 to 1; a pair takes the larger",
    )
    compliance: Annotated[float, Quantity("m/N", minimum=0)] = Field(
        default=0.0, description="[m/N] indentation per force; the two surfaces of a contact add"
    )


class Plane(ConfigModel):
    """The half-space n.x <= offset, always static."""

    kind: Literal["plane"]
    normal: Direction = Field(default=(0.0, 0.0, 1.0), description="outward normal; is normalised")
    offset: Annotated[float, Quantity("m")] = Field(
        default=0.0, description="[m] n.x of its points"
    )


class Sphere(ConfigModel):
    """A ball."""

    kind: Literal["sphere"]
    radius: Annotated[float, Quantity("m", above=0)] = Field(description="[m]")


class Box(ConfigModel):
    """A rectangular block."""

    kind: Literal["box"]
    size: BoxSize = Field(description="[m] full edge lengths along the body's x, y, z")


Shape = Annotated[Plane | Sphere | Box, Field(discriminator="kind")]


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


class AxisAngle(ConfigModel):
    """A rotation by an angle about an axis."""

    axis: Direction = Field(description="axis of rotation, world frame; is normalised")
    degrees: Annotated[float, Quantity("degree")] = Field(description="[degree] right-handed angle")


def _orientation_form(value: Any) -> str | None:
    forms: dict[type, str] = {tuple: "quaternion", list: "quaternion", dict: "rotation"}
    return forms.get(type(value))


Quaternion = Annotated[
    tuple[float, float, float, float], Vector(4, Quantity(), nonzero=True), Tag("quaternion")
]
Orientation = Annotated[
    Quaternion | Annotated[AxisAngle, Tag("rotation")],
    either("a quaternion [w, x, y, z] or {axis: [x, y, z], degrees: angle}", _orientation_form),
]


def _gravity_form(value: Any) -> str:
    return "vector" if isinstance(value, list | tuple) else "magnitude"


Gravity = Annotated[
    Annotated[
        float,
        Quantity("m/s^2", minimum=0, hint="a number is the magnitude along -z"),
        Tag("magnitude"),
    ]
    | Annotated[Vector3, Vector(3, Quantity("m/s^2")), Tag("vector")],
    either("a number or a list of 3 numbers [m/s^2]", _gravity_form),
]


def _surface_form(value: Any) -> str | None:
    forms: dict[type, str] = {str: "name", dict: "properties"}
    return forms.get(type(value))


SurfaceOf = Annotated[
    Annotated[SurfaceName, Tag("name")] | Annotated[Surface, Tag("properties")],
    either("the name of a surface or {restitution: ..., compliance: ...}", _surface_form),
]


class Body(ConfigModel):
    """One rigid body. Planes are static; a movable body has exactly one of mass and density."""

    shape: Shape = Field(description="plane, sphere or box")
    mass: Annotated[float, Quantity("kg", above=0, hint=STATIC_HINT)] | None = Field(
        default=None, description="[kg]"
    )
    density: Annotated[float, Quantity("kg/m^3", above=0)] | None = Field(
        default=None, description="[kg/m^3]"
    )
    fixed: bool = Field(default=False, description="true: never moves, has no mass")
    surface: SurfaceOf = Field(
        default=Surface(), description="name of one of scene.surfaces, or its properties in place"
    )
    position: Position | None = Field(default=None, description="[m] centre of mass, world frame")
    release: Release | None = Field(
        default=None, description="start above a plane, instead of position"
    )
    orientation: Orientation = Field(
        default=(1.0, 0.0, 0.0, 0.0),
        description="quaternion w x y z, or axis and degrees; is normalised",
    )
    velocity: Velocity = Field(default=(0.0, 0.0, 0.0), description="[m/s] of the centre of mass")
    angular_velocity: AngularVelocity = Field(
        default=(0.0, 0.0, 0.0), description="[rad/s] world frame, right-handed"
    )


class Scene(ConfigModel):
    """What is there: gravity, surfaces and bodies, in the order in which they are written."""

    gravity: Gravity = Field(
        default=GRAVITY, description="[m/s^2] magnitude along -z, or a vector [gx, gy, gz]"
    )
    surfaces: dict[NewName, Surface] = Field(
        default={}, description="named surfaces, shared by bodies"
    )
    bodies: dict[NewName, Body] = Field(description="name of the body: its properties")
