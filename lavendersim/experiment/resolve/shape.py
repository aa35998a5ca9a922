"""Resolving a shape: its principal frame, volume and moments of inertia (homogeneous solids)."""

from __future__ import annotations

from typing import NamedTuple

from lavendersim.cell.shapes import CellCompound, CellHull, CellPart, CellSimple, Primitive
from lavendersim.experiment.models.shapes import AxisAngle, Compound, Simple
from lavendersim.experiment.resolve.placement import SceneError, below
from lavendersim.geometry.convex_hull import FlatError, convex_hull
from lavendersim.geometry.mass_properties import (
    ORIGIN,
    Placed,
    Solid,
    homogeneous,
    polyhedron,
    together,
)
from lavendersim.geometry.quaternions import IDENTITY, from_axis_angle, inverse, product, to_body
from lavendersim.geometry.vectors import minus, unit
from lavendersim.quantities.quantity import Quaternion, Vector3


class SolidShape(NamedTuple):
    """A shape in its principal frame, and what a homogeneous body of it is."""

    shape: CellSimple | CellCompound
    volume: float  # [m^3]
    inertia_per_mass: Vector3  # [m^2] principal moments
    axes: Quaternion  # principal frame to the frame as written


def resolve_shape(shape: Simple | Compound) -> SolidShape:
    """Return a shape in its principal frame; raises SceneError, path from the shape."""
    if isinstance(shape, Compound):
        return _compound(shape)
    resolved, solid = _simple(shape)
    moments = (solid.inertia[0][0], solid.inertia[1][1], solid.inertia[2][2])
    axes = resolved.axes if isinstance(resolved, CellHull) else IDENTITY
    return SolidShape(resolved, solid.volume, moments, axes)


def quaternion_of(orientation: Quaternion | AxisAngle) -> Quaternion:
    """Return an orientation as written as a unit quaternion."""
    if isinstance(orientation, AxisAngle):
        return from_axis_angle(orientation.axis, orientation.degrees)
    return unit(orientation)


def _simple(shape: Simple) -> tuple[CellSimple, Solid]:
    """Return a convex shape in its principal frame, and its solid in that frame."""
    if isinstance(shape, Primitive):
        return shape, homogeneous(*shape.homogeneous())
    try:
        hull = convex_hull(shape.corners())
    except FlatError:
        sentence = "points: all of them lie in one plane; a hull needs a volume"
        raise SceneError(("points",), sentence) from None
    solid = polyhedron(hull)
    (x, y, z), axes = solid.principal()
    points = tuple(to_body(axes, minus(point, solid.centre)) for point in hull.points)
    moments = ((x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z))
    resolved = CellHull(
        kind="hull", points=points, faces=hull.faces, centre=solid.centre, axes=axes
    )
    return resolved, Solid(solid.volume, ORIGIN, moments)


def _compound(compound: Compound) -> SolidShape:
    shapes: list[CellSimple] = []
    placed: list[Placed] = []
    for index, part in enumerate(compound.parts):
        with below("parts", index, "shape"):
            shape, solid = _simple(part.shape)
        turn = quaternion_of(part.orientation)
        if isinstance(shape, CellHull):
            turn = product(turn, shape.axes)
        shapes.append(shape)
        placed.append(Placed(solid, part.position, turn))
    whole = together(placed)
    moments, axes = whole.principal()
    back = inverse(axes)
    parts = tuple(
        CellPart(
            shape=shape,
            position=to_body(axes, minus(part.position, whole.centre)),
            orientation=product(back, part.orientation),
        )
        for shape, part in zip(shapes, placed, strict=True)
    )
    resolved = CellCompound(kind="compound", parts=parts, centre=whole.centre, axes=axes)
    return SolidShape(resolved, whole.volume, moments, axes)
