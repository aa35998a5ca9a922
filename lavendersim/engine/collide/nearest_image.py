"""Nearest images in a periodic cell (minimum image convention; Metropolis and others 1953).

    x_B' = x_B + L round((x_A - x_B)/L)      along each axis on which both bodies have a period L

Poses are not wrapped: a body goes on beyond the cell, and acts there on what is near an image of
it. A contact is where A stands, so that the lever of B is that of its image. Where the radii of two
bodies are less than half a period together, and they move by less than a quarter of it in a step,
one image of B alone can touch A, and it is the nearest.
"""

from __future__ import annotations

from math import floor
from typing import Any

from ..compile import inner, kernel
from ..spec import Spec
from ..step_terms import step_terms
from ..vectors import Vec3, position
from .records import put_position


@inner
def moved_near(x, other, period):
    """Return the coordinate of the image of `other` that is nearest to x [m]; period 0: itself."""
    if period > 0.0:
        return other + period * floor((x - other) / period + 0.5)
    return other


@inner
def nearest_image(a, b):
    """Return where the image of B is that is nearest to A [m]; rows of bodies."""
    return Vec3(
        moved_near(a.x, b.x, min(a.period_x, b.period_x)),
        moved_near(a.y, b.y, min(a.period_y, b.period_y)),
        moved_near(a.z, b.z, min(a.period_z, b.period_z)),
    )


@inner
def own_place(a, b):
    """Return where B is [m]."""
    return position(b)


def place_beside(spec: Spec) -> Any:
    """Return the function (a, b) -> where B is as A meets it [m]; rows of bodies."""
    return nearest_image if step_terms(spec).periodic else own_place


def make_beside(spec: Spec, manifold: Any) -> Any:
    """Return `kernel(kind, a, b, margin, scratch) -> count` of a manifold, of B's nearest image.

    The row of B is left as it was.
    """
    if not step_terms(spec).periodic:
        return manifold

    def manifold_beside(kind, a, b, margin, scratch):
        start = position(b)
        put_position(b, nearest_image(a, b))
        count = manifold(kind, a, b, margin, scratch)
        put_position(b, start)
        return count

    return kernel(manifold_beside, spec)


def make_swept_beside(spec: Spec, swept: Any) -> Any:
    """Return `kernel(kind, a, b, d, margin, scratch) -> (count, t)`, likewise of `swept`."""
    if not step_terms(spec).periodic:
        return swept

    def swept_beside(kind, a, b, d, margin, scratch):
        start = position(b)
        put_position(b, nearest_image(a, b))
        count, t = swept(kind, a, b, d, margin, scratch)
        put_position(b, start)
        return count, t

    return kernel(swept_beside, spec)
