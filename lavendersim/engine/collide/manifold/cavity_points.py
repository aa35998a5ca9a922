"""Contact points of what is inside a cavity A, a bowl or a drum of radius R.

             __wall__
            /   u    \\       d = p - c, across the axis of a drum; u = d/|d|
           |    ^     |      phi = R - |d| - r,   n = -u: from the wall to the body
           |  p |     |
            \\   c    /       p: a point of the body's core, grown by a radius r
             --------

The wall is farther from c than any point of the body, so the point of a body that is nearest to the
wall is the one that is farthest from c: an end of a capsule, a corner, a point of a rim.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...compile import kernel, once
from ...records import DRUM
from ...spec import Spec
from ...vectors import Vec3, dot, length, minus, plus_scaled, position, scaled
from ..shapes import has_drum
from .own_normals import put_point_normal
from .point import place, put_manifold_normal

# What is nearer to the centre or the axis has no direction from it, in radii of the cavity [-].
NO_DIRECTION = 1e-12


class CorePoint(NamedTuple):
    """A point of a body's core that may be the farthest."""

    p: Vec3  # world frame [m]
    r: float  # radius that it is grown by [m]
    feature: int


@once
def make_axis(spec: Spec) -> Any:
    """Return `kernel(cavity) -> unit vector` along the axis of a drum; of a bowl 0."""
    drums = has_drum(spec)

    def axis_of(cavity):
        axis = Vec3(0.0, 0.0, 0.0)
        if drums:
            if cavity.shape == DRUM:
                axis = Vec3(cavity.r02, cavity.r12, cavity.r22)
        return axis

    return kernel(axis_of, spec)


@once
def make_from_centre(spec: Spec) -> Any:
    """Return `kernel(cavity, p) -> d`: of a point of the world [m]."""
    axis_of = make_axis(spec)

    def from_centre(cavity, p):
        d, axis = minus(p, position(cavity)), axis_of(cavity)
        return plus_scaled(d, -dot(d, axis), axis)

    return kernel(from_centre, spec)


@once
def make_put_point(spec: Spec) -> Any:
    """Return `kernel(cavity, core, margin, manifold, count) -> count`, one more if near."""
    from_centre, drums = make_from_centre(spec), has_drum(spec)

    def put_point(cavity, core, margin, manifold, count):
        p, r, feature = core.p, core.r, core.feature
        d = from_centre(cavity, p)
        far = length(d)
        phi = cavity.hx - far - r
        if not phi <= margin:
            return count
        u = Vec3(0.0, 0.0, -1.0)
        if drums:
            if cavity.shape == DRUM:
                u = Vec3(cavity.r00, cavity.r10, cavity.r20)
        if far > NO_DIRECTION * cavity.hx:
            u = scaled(1.0 / far, d)
        n = scaled(-1.0, u)
        place(manifold.points[count], plus_scaled(p, r + 0.5 * phi, u), phi, feature)
        put_point_normal(manifold, count, n)
        if count == 0:
            put_manifold_normal(manifold, n)
        return count + 1

    return kernel(put_point, spec)
