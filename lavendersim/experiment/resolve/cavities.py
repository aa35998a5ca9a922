"""What does not fit into a cavity of its scene, or would touch it in points that are not found.

An ellipsoid has one point that is farthest from the centre or the axis, where all its radii of
curvature are less than the cavity's: the largest is that of its flattest point, a^2/c.
"""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.cell.shapes import Cavity, CellCompound, CellShape, Convex, Ellipsoid
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.resolve.placement import SceneError


def refuse_what_does_not_fit(shape: CellShape, scene: Scene) -> None:
    """Raise SceneError, its path from the shape, for a cavity that is too narrow for it."""
    for name, body in scene.bodies.items():
        if isinstance(body.shape, Cavity):
            for one in _solids(shape):
                _refuse_in(one, name, body.shape)


def _solids(shape: CellShape) -> Iterator[Convex]:
    if isinstance(shape, CellCompound):
        yield from (part.shape for part in shape.parts)
    elif isinstance(shape, Convex):
        yield shape


def _refuse_in(shape: Convex, name: str, cavity: Cavity) -> None:
    radius = cavity.radius
    if shape.kind not in cavity.HOLDS:
        what = f"a {shape.kind} touches {name}, a {cavity.kind}"
        raise SceneError((), f"no file of engine/collide/pairs says where {what}")
    if shape.thickness() >= 2.0 * radius:
        raise SceneError(
            (),
            f"it does not fit into {name}, the {cavity.kind} of radius {radius:g} m: it is "
            f"{shape.thickness():g} m thick",
        )
    if isinstance(shape, Ellipsoid):
        flattest = max(shape.semi_axes) ** 2 / min(shape.semi_axes)
        if flattest >= radius:
            raise SceneError(
                (),
                f"an ellipsoid so flat may touch {name}, a {cavity.kind}, in two points at once; "
                f"expected (longest semi-axis)^2/(shortest) below its radius, {radius:g} m, "
                f"found {flattest:g} m",
            )
