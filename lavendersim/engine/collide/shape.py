"""What collision detection knows of a shape: its number in BODY.shape, and where its kernels are.

A shape is its core, grown by a radius: a sphere is a point, a capsule a segment, grown by theirs,
an ellipsoid a smooth body, grown by part of its least radius of curvature; boxes, cylinders and
hulls are their own cores. A new convex shape is one file in `shapes` and a `Shape` in
`shapes.DECLARED`: it collides with every other by GJK and EPA, where no file of `pairs` has a
closed form. What it is to a config and to views: `cell/shapes`.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final, NamedTuple

from ..records import Field
from ..spec import Spec

Maker = Callable[[Spec], Any]
# What the file of a shape may define, each a `Maker`. Kernels take and give vectors as `Vec3`,
# directions of any length.
MAKERS: Final = (
    # kernel(body, direction, hulls) -> the point of the core farthest along it, from the centre,
    # along the world's axes; without a file the core is the centre
    "make_support",
    # kernel(body) -> radius of the ball that a rounded core is grown by [m]; none: BODY.hx
    "make_radius",
    # kernel(body) -> half edges of its axis-aligned box in the world [m]; none: of its bounding
    # sphere
    "make_half_extents",
    # kernel(body, n, hulls) -> (face, outward normal) of the flat face whose normal is nearest to n
    "make_face",
    # kernel(body, centre, n, hulls, outline) -> the `Feature` that looks along n, corners written
    # to `outline`, relative to A's centre as `centre` is; none: a point
    "make_feature",
    # kernel(body, centre, n, hulls, outline) -> likewise the edge that is highest along n, even
    # where a face looks along n; none: no edges
    "make_edge",
)


class Shape(NamedTuple):
    """A shape of bodies; to declare it loads none of its kernels."""

    name: str
    kind: int = -1  # of BODY.shape; without one of its own, its place in the list
    kernels: bool = False  # whether the file of its name has any; else its core is its centre
    rounded: bool = False  # whether the core is grown by a radius, `make_radius`
    curved: bool = False  # whether the core itself has a curved side
    polyhedral: bool = False  # whether its faces are polygons
    concave: bool = False  # whether its kernels are those of its pieces, one at a time
    oriented: bool = True  # whether its body needs ORIENTED_BODY
    fields: tuple[Field, ...] = ()  # further columns of its body

    @property
    def convex(self) -> bool:
        """Whether it is the convex hull of a bounded core, grown by a radius."""
        return (self.rounded or self.kernels) and not self.concave

    def maker(self, name: str) -> Maker | None:
        """Return one of `MAKERS` from its file; None where it has none of that name."""
        if not self.kernels:
            return None
        file = import_module(f".shapes.{self.name}", __package__)
        found: Maker | None = getattr(file, name, None)
        return found
