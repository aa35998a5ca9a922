"""The shapes of a config as written, and how a body or a part of one is turned.

Every shape has a frame of its own. Of a hull and of a compound only its axes count: the body stands
where its centre of mass stands.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, Tag

from lavendersim.experiment.base import ConfigModel
from lavendersim.experiment.quantities import (
    BoxSize,
    Direction,
    Position,
    Quantity,
    Vector,
    either,
)

Length = Annotated[float, Quantity("m", above=0)]
MOST_POINTS = 256  # of a hull: features of contacts are counted in eight bits
MOST_PARTS = 256


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
    radius: Length = Field(description="[m]")


class Box(ConfigModel):
    """A rectangular block."""

    kind: Literal["box"]
    size: BoxSize = Field(description="[m] full edge lengths along the body's x, y, z")


class Capsule(ConfigModel):
    """A cylinder along the body's z with a half ball on each end."""

    kind: Literal["capsule"]
    radius: Length = Field(description="[m]")
    length: Length = Field(description="[m] of the cylinder between the half balls")


class Cylinder(ConfigModel):
    """A round bar along the body's z."""

    kind: Literal["cylinder"]
    radius: Length = Field(description="[m]")
    length: Length = Field(description="[m] from end to end")


class Hull(ConfigModel):
    """The convex hull of points; those inside of it count for nothing."""

    kind: Literal["hull"]
    points: tuple[Position, ...] = Field(
        min_length=4,
        max_length=MOST_POINTS,
        description="[m] in a frame whose axes are the body's; only differences count",
    )


class AxisAngle(ConfigModel):
    """A rotation by an angle about an axis."""

    axis: Direction = Field(description="axis of rotation, world frame; is normalised")
    degrees: Annotated[float, Quantity("degree")] = Field(description="[degree] right-handed angle")


def _orientation_form(value: Any) -> str | None:
    forms: dict[type, str] = {tuple: "quaternion", list: "quaternion", dict: "rotation"}
    return forms.get(type(value))


Orientation = Annotated[
    Annotated[
        tuple[float, float, float, float], Vector(4, Quantity(), nonzero=True), Tag("quaternion")
    ]
    | Annotated[AxisAngle, Tag("rotation")],
    either("a quaternion [w, x, y, z] or {axis: [x, y, z], degrees: angle}", _orientation_form),
]

Simple = Sphere | Box | Capsule | Cylinder | Hull


class Part(ConfigModel):
    """One convex piece of a compound."""

    shape: Annotated[Simple, Field(discriminator="kind")] = Field(
        description="sphere, box, capsule, cylinder or hull"
    )
    position: Position = Field(
        default=(0.0, 0.0, 0.0), description="[m] of its centre of mass, in the compound's frame"
    )
    orientation: Orientation = Field(
        default=(1.0, 0.0, 0.0, 0.0),
        description="part to compound: quaternion w x y z, or axis and degrees; is normalised",
    )


class Compound(ConfigModel):
    """Several shapes that move as one body; where parts overlap, their mass counts twice."""

    kind: Literal["compound"]
    parts: tuple[Part, ...] = Field(
        min_length=1,
        max_length=MOST_PARTS,
        description="share the mass by their volumes; their frame's axes are the body's",
    )


Solid = Sphere | Box | Capsule | Cylinder | Hull | Compound
Shape = Annotated[
    Plane | Sphere | Box | Capsule | Cylinder | Hull | Compound, Field(discriminator="kind")
]
