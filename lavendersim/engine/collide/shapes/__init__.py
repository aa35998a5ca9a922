"""The shapes of bodies; the kernels of each stand in the file of its name.

Shapes are declared here, which loads no kernel: plans are made without numba.
"""

from __future__ import annotations

from typing import Any

from ...records import (
    BOWL,
    BOX,
    CAPSULE,
    CAVITIES,
    COMPOUND,
    CONE,
    CYLINDER,
    DRUM,
    ELLIPSOID,
    HULL,
    HULL_BODY,
    MESH,
    MESH_BODY,
    PLANE,
    SPHERE,
)
from ...spec import Spec
from ..shape import Shape

DECLARED = (
    Shape("plane", PLANE, oriented=False),
    Shape("sphere", SPHERE, rounded=True, oriented=False),
    Shape("box", BOX, kernels=True, polyhedral=True),
    Shape("capsule", CAPSULE, kernels=True, rounded=True),
    Shape("cylinder", CYLINDER, kernels=True, curved=True),
    Shape("hull", HULL, kernels=True, polyhedral=True, fields=tuple(HULL_BODY)),
    Shape("compound", COMPOUND),  # its parts collide, each as a shape of its own
    Shape("ellipsoid", ELLIPSOID, kernels=True, rounded=True, curved=True),
    Shape("bowl", BOWL, oriented=False),
    Shape("drum", DRUM),  # its axis is the body's z
    Shape("mesh", MESH, kernels=True, concave=True, fields=tuple(MESH_BODY)),
    Shape("cone", CONE, kernels=True, curved=True),
)

SHAPES = {
    shape.name: shape if shape.kind >= 0 else shape._replace(kind=place)
    for place, shape in enumerate(DECLARED)
}


def shapes_in(spec: Spec) -> list[Shape]:
    """Return the shapes that the pairs of `spec` hold, in the order of `SHAPES`."""
    from ..pairs import SHAPE_PAIRS  # pairs that no file has are made of the list above

    names = {name for pair in spec.shape_pairs for name in SHAPE_PAIRS[pair].shapes}
    return [shape for name, shape in SHAPES.items() if name in names]


def has_cavity(spec: Spec) -> bool:
    """Whether a body of `spec` may be inside another one."""
    return any(shape.name in CAVITIES for shape in shapes_in(spec))


def has_mesh(spec: Spec) -> bool:
    """Whether a body of `spec` may touch a mesh."""
    return any(shape.kind == MESH for shape in shapes_in(spec))


def make_is_inside(spec: Spec) -> tuple[bool, Any]:
    """Return whether B of a pair is inside of A, and `kernel(kind) -> whether` that of one is."""
    from ...compile import kernel  # with numba
    from ..pairs import SHAPE_PAIRS

    pairs = [SHAPE_PAIRS[name] for name in spec.shape_pairs]
    kinds = tuple(pair.kind for pair in pairs if pair.inside)
    if not kinds:
        return False, None

    def is_inside(kind):
        return kind in kinds

    return True, kernel(is_inside, spec)


def has_drum(spec: Spec) -> bool:
    """Whether a body of `spec` may be inside a drum."""
    return any(shape.kind == DRUM for shape in shapes_in(spec))


def has_curved(spec: Spec) -> bool:
    """Whether a core of `spec` has a curved side."""
    return any(shape.curved for shape in shapes_in(spec))
