"""Shapes of bodies: half-space, sphere, box, capsule, cylinder, convex hull and compound.

Each has a frame of its own. The frame of a body has its origin in the centre of mass and its axes
along the principal axes of the shape; corners of hulls and parts of compounds are given in it.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.quantities.model import ConfigModel, ResolvedModel
from lavendersim.quantities.quantity import BoxSize, Direction, Quantity, Quaternion, Vector3

Length = Annotated[float, Quantity("m", above=0)]


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


class CellHull(ResolvedModel):
    """A convex polyhedron in its principal frame."""

    kind: Literal["hull"]
    points: tuple[Vector3, ...]  # [m] corners
    faces: tuple[tuple[int, ...], ...]  # rows of `points`, counter-clockwise seen from outside
    centre: Vector3  # [m] the centre of mass in the frame as written
    axes: Quaternion  # principal frame to frame as written


CellSimple = Annotated[Sphere | Box | Capsule | Cylinder | CellHull, Field(discriminator="kind")]


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


CellShape = Annotated[
    Plane | Sphere | Box | Capsule | Cylinder | CellHull | CellCompound, Field(discriminator="kind")
]
