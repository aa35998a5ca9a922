"""The shapes of a config as written, and how a body or a part of one is turned.

Every shape has a frame of its own. Of a hull and of a compound only its axes count: the body stands
where its centre of mass stands.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, Union

from pydantic import Field, Tag

from lavendersim.cell.shapes import PRIMITIVE_KINDS, PRIMITIVES, Plane, Primitive
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import (
    Direction,
    Position,
    Quantity,
    Vector,
    either,
)

MOST_POINTS = 256  # of a hull: features of contacts are counted in eight bits
MOST_PARTS = 256


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

if TYPE_CHECKING:
    Simple = Primitive | Hull
else:
    Simple = Union[(*PRIMITIVES, Hull)]


class Part(ConfigModel):
    """One convex piece of a compound."""

    shape: Annotated[Simple, Field(discriminator="kind")] = Field(
        description=f"{', '.join(PRIMITIVE_KINDS)} or hull"
    )
    position: Position = Field(
        default=(0.0, 0.0, 0.0), description="[m] of its centre of mass, in the compound's frame"
    )
    orientation: Orientation = Field(
        default=(1.0, 0.0, 0.0, 0.0),
        description="part to compound: quaternion w x y z, or `{axis, degrees}`; both are "
        "normalised",
    )


class Compound(ConfigModel):
    """Several shapes that move as one body; where parts overlap, their mass counts twice."""

    kind: Literal["compound"]
    parts: tuple[Part, ...] = Field(
        min_length=1,
        max_length=MOST_PARTS,
        description="share the mass by their volumes; their frame's axes are the body's",
    )


if TYPE_CHECKING:
    Solid = Primitive | Hull | Compound
    Shape = Plane | Primitive | Hull | Compound
else:
    Solid = Union[(*PRIMITIVES, Hull, Compound)]
    Shape = Annotated[Union[(Plane, Solid)], Field(discriminator="kind")]  # noqa: UP007
