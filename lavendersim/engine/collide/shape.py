"""What collision detection knows of a shape: its number in BODY.shape and its kernels.

A shape is its core, grown by a radius: a sphere is a point, a capsule a segment, grown by theirs;
boxes, cylinders and hulls are their own cores. A new convex shape is one file in `shapes` that
declares a `Shape`, and its place in `shapes.DECLARED`: it collides with every other by GJK and EPA,
where no file of `pairs` has a closed form. What it is to a config and to views: `cell/shapes`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from ..records import Field
from ..spec import Spec

Maker = Callable[[Spec], Any]


class Shape(NamedTuple):
    """A shape of bodies. Kernels take and give vectors as `Vec3`, directions of any length."""

    name: str
    kind: int = -1  # of BODY.shape; without one of its own, its place in the list
    # kernel(body, direction, hulls) -> the point of the core farthest along it, from the centre,
    # along the world's axes; none: the core is the centre
    make_support: Maker | None = None
    # kernel(body) -> half edges of its axis-aligned box in the world [m]; none: of its bounding
    # sphere
    make_half_extents: Maker | None = None
    # kernel(body, n, hulls) -> (face, outward normal) of the flat face whose normal is nearest to n
    make_face: Maker | None = None
    # kernel(body, centre, n, hulls, outline) -> the `Feature` that looks along n, corners written
    # to `outline`, relative to A's centre as `centre` is; none: a point
    make_feature: Maker | None = None
    # kernel(body, centre, n, hulls, outline) -> likewise the edge that is highest along n, even
    # where a face looks along n; none: no edges
    make_edge: Maker | None = None
    rounded: bool = False  # whether the core is grown by the radius BODY.hx
    curved: bool = False  # whether the core itself has a curved side
    polyhedral: bool = False  # whether its faces are polygons
    oriented: bool = True  # whether its body needs ORIENTED_BODY
    fields: tuple[Field, ...] = ()  # further columns of its body

    @property
    def convex(self) -> bool:
        """Whether it is the convex hull of a bounded core, grown by a radius."""
        return self.rounded or self.make_support is not None
