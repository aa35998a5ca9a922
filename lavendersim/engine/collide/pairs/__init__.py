"""Manifolds of two bodies, one file per pair of shapes; `convex` serves what has no closed form."""

from ..shape_pair import numbered
from . import (
    box_box,
    box_plane,
    capsule_capsule,
    capsule_plane,
    convex,
    cylinder_plane,
    hull_plane,
    sphere_box,
    sphere_capsule,
    sphere_cylinder,
    sphere_plane,
    sphere_sphere,
)

# By name. The order is that of reports, and numbers the pairs in the engine's tables.
SHAPE_PAIRS = numbered(
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
