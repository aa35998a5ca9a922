"""Kernels that ask the shape of a body; each holds only the shapes that its `Spec` has pairs of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..compile import inner, kernel, once
from ..spec import Spec
from ..vectors import Vec3
from .records import NO_FEATURE
from .shape import Maker, Shape
from .shapes import shapes_in


def by_shape(spec: Spec, maker_of: Callable[[Shape], Maker | None], otherwise: Any) -> Any:
    """Return `kernel(body, ...)`: what the body's shape has for it, or `otherwise`."""
    makers = [(shape, maker_of(shape)) for shape in shapes_in(spec)]
    found = otherwise
    for shape, maker in reversed(makers):
        if maker is not None:
            found = _first(spec, shape, maker(spec), found)
    return found


def _first(spec: Spec, shape: Shape, own: Any, others: Any) -> Any:
    kind = shape.kind

    def of_shape(body, *arguments):
        if body.shape == kind:
            return own(body, *arguments)
        return others(body, *arguments)

    return kernel(of_shape, spec)


def by_flag(spec: Spec, has: Callable[[Shape], bool], where_so: Any, otherwise: Any) -> Any:
    """Return `kernel(body)`: one of two, by a property of the body's shape."""
    return by_shape(spec, lambda shape: (lambda _: where_so) if has(shape) else None, otherwise)


@inner
def no_point(body, direction, hulls):
    """Return the centre."""
    return Vec3(0.0, 0.0, 0.0)


@inner
def no_face(body, n, hulls):
    """Return that no face looks along n."""
    return -1, Vec3(0.0, 0.0, 0.0)


@inner
def no_feature(body, centre, n, hulls, outline):
    """Return that nothing flat looks along n."""
    return NO_FEATURE


@inner
def bounding_extents(body):
    """Return half edges of the box around the bounding sphere [m]."""
    return Vec3(body.bound, body.bound, body.bound)


@inner
def own_radius(body):
    """Return the radius of a rounded shape that has no other [m]."""
    return body.hx


@inner
def no_radius(body):
    """Return the radius of a shape that is its core."""
    return 0.0


@inner
def holds(body):
    """Return that a property holds."""
    return True


@inner
def holds_not(body):
    """Return that a property does not hold."""
    return False


@once
def make_support(spec: Spec) -> Any:
    """Return `kernel(body, direction, hulls) -> Vec3`: the support mapping of the core.

    It is relative to the body's centre; hulls: the tables of hull_geometry.py.
    """
    return by_shape(spec, lambda shape: shape.maker("make_support"), no_point)


@once
def make_half_extents(spec: Spec) -> Any:
    """Return `kernel(body) -> Vec3`: half edges of its axis-aligned box in the world [m]."""
    return by_shape(spec, lambda shape: shape.maker("make_half_extents"), bounding_extents)


@once
def make_best_face(spec: Spec) -> Any:
    """Return `kernel(body, n, hulls) -> (face, outward normal)`, face -1 where there is none."""
    return by_shape(spec, lambda shape: shape.maker("make_face"), no_face)


@once
def make_feature(spec: Spec) -> Any:
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`: what looks along n."""
    return by_shape(spec, lambda shape: shape.maker("make_feature"), no_feature)


@once
def make_edge(spec: Spec) -> Any:
    """Return `kernel(body, centre, n, hulls, outline) -> Feature`: its highest edge along n."""
    return by_shape(spec, lambda shape: shape.maker("make_edge"), no_feature)


@once
def make_radius(spec: Spec) -> Any:
    """Return `kernel(body) -> radius of the ball that the core is grown by` [m]."""

    def maker_of(shape: Shape) -> Maker | None:
        own = shape.maker("make_radius")
        return own if own is not None or not shape.rounded else lambda _: own_radius

    return by_shape(spec, maker_of, no_radius)


@once
def make_is_curved(spec: Spec) -> Any:
    """Return `kernel(body) -> whether its core has a curved side`."""
    return by_flag(spec, lambda shape: shape.curved, holds, holds_not)


@once
def make_is_polyhedral(spec: Spec) -> Any:
    """Return `kernel(body) -> whether its faces are polygons`."""
    return by_flag(spec, lambda shape: shape.polyhedral, holds, holds_not)
