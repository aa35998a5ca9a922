"""Bodies and candidate pairs enter, manifold points leave; one file per shape pair."""

from . import box_box, box_plane, sphere_box, sphere_plane, sphere_sphere

# The order of the shapes in a pair is the order of the kernel's arguments.
SHAPE_PAIRS = {
    "sphere_plane": (0, ("plane", "sphere"), sphere_plane),
    "box_plane": (1, ("plane", "box"), box_plane),
    "sphere_sphere": (2, ("sphere", "sphere"), sphere_sphere),
    "sphere_box": (3, ("box", "sphere"), sphere_box),
    "box_box": (4, ("box", "box"), box_box),
}
