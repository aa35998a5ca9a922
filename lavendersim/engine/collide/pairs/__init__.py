"""Manifolds of two bodies, one file per pair of shapes.

`convex` and `convex_plane` serve what has no closed form.
"""

from itertools import combinations_with_replacement

from ..shape_pair import ShapePair, numbered
from ..shapes import SHAPES
from . import (
    box_box,
    box_plane,
    capsule_capsule,
    capsule_plane,
    convex,
    convex_plane,
    cylinder_plane,
    hull_plane,
    sphere_box,
    sphere_capsule,
    sphere_cylinder,
    sphere_plane,
    sphere_sphere,
)

DECLARED = (
    sphere_plane.PAIR,
    box_plane.PAIR,
    sphere_sphere.PAIR,
    sphere_box.PAIR,
    box_box.PAIR,
    capsule_plane.PAIR,
    sphere_capsule.PAIR,
    convex.CAPSULE_BOX,
    capsule_capsule.PAIR,
    cylinder_plane.PAIR,
    sphere_cylinder.PAIR,
    convex.CYLINDER_BOX,
    convex.CAPSULE_CYLINDER,
    convex.CYLINDER_CYLINDER,
    hull_plane.PAIR,
    *convex.WITH_HULLS,
)


def undeclared() -> list[ShapePair]:
    """Return the pairs of shapes that no file has, by the kernels for any convex shapes."""
    known = {frozenset(pair.shapes) for pair in DECLARED}
    names = ["plane", *(shape.name for shape in SHAPES.values() if shape.convex)]
    return [
        ShapePair(f"{b}_{a}", (a, b), convex_plane.make if a == "plane" else convex.make)
        for a, b in combinations_with_replacement(names, 2)
        if {a, b} not in known and b != "plane"
    ]


# By name. The order is that of reports, and numbers the pairs in the engine's tables.
SHAPE_PAIRS = numbered(*DECLARED, *undeclared())
