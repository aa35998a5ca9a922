"""Bodies and candidate pairs enter, manifold points leave; one file per shape pair.

`convex` serves the pairs that have no closed form.
"""

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

# The order of the shapes in a pair is the order of the kernel's arguments.
SHAPE_PAIRS = {
    "sphere_plane": (0, ("plane", "sphere"), sphere_plane),
    "box_plane": (1, ("plane", "box"), box_plane),
    "sphere_sphere": (2, ("sphere", "sphere"), sphere_sphere),
    "sphere_box": (3, ("box", "sphere"), sphere_box),
    "box_box": (4, ("box", "box"), box_box),
    "capsule_plane": (5, ("plane", "capsule"), capsule_plane),
    "sphere_capsule": (6, ("capsule", "sphere"), sphere_capsule),
    "capsule_box": (7, ("box", "capsule"), convex),
    "capsule_capsule": (8, ("capsule", "capsule"), capsule_capsule),
    "cylinder_plane": (9, ("plane", "cylinder"), cylinder_plane),
    "sphere_cylinder": (10, ("cylinder", "sphere"), sphere_cylinder),
    "cylinder_box": (11, ("box", "cylinder"), convex),
    "capsule_cylinder": (12, ("cylinder", "capsule"), convex),
    "cylinder_cylinder": (13, ("cylinder", "cylinder"), convex),
    "hull_plane": (14, ("plane", "hull"), hull_plane),
    "sphere_hull": (15, ("hull", "sphere"), convex),
    "hull_box": (16, ("box", "hull"), convex),
    "capsule_hull": (17, ("hull", "capsule"), convex),
    "cylinder_hull": (18, ("hull", "cylinder"), convex),
    "hull_hull": (19, ("hull", "hull"), convex),
}
