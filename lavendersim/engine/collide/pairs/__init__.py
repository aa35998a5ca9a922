"""Manifolds of two bodies, one file per pair of shapes.

`convex` and `convex_plane` serve what has no closed form. Pairs are declared here, which loads no
kernel: plans are made without numba.
"""

from itertools import combinations_with_replacement

from ..shape_pair import ShapePair, numbered
from ..shapes import SHAPES


def own(a: str, b: str, closed_form: bool = False) -> ShapePair:
    """Return a pair, A's shape first, that the file of its name has."""
    name = f"{b}_{a}"
    return ShapePair(name, (a, b), name, closed_form)


def by_gjk(a: str, b: str) -> ShapePair:
    """Return a pair that goes by GJK and EPA."""
    return ShapePair(f"{b}_{a}", (a, b), "convex")


def inside(cavity: str, b: str, file: str) -> ShapePair:
    """Return the pair of a cavity and what is in it, whose points have normals of their own."""
    return ShapePair(f"{b}_{cavity}", (cavity, b), f"{file}_cavity", own_normals=True, inside=True)


def on_mesh(b: str) -> ShapePair:
    """Return the pair of a mesh and a convex shape, whose points have normals of their own."""
    return ShapePair(f"{b}_mesh", ("mesh", b), f"{b}_mesh", own_normals=True)


def smooth(a: str) -> ShapePair:
    """Return the pair of a shape with an ellipsoid: Newton's method behind GJK and EPA."""
    return ShapePair(f"ellipsoid_{a}", (a, "ellipsoid"), "ellipsoid_convex")


DECLARED = (
    own("plane", "sphere"),
    own("plane", "box"),
    own("sphere", "sphere", closed_form=True),
    own("box", "sphere", closed_form=True),
    own("box", "box"),
    own("plane", "capsule"),
    own("capsule", "sphere", closed_form=True),
    by_gjk("box", "capsule"),
    own("capsule", "capsule", closed_form=True),
    own("plane", "cylinder"),
    own("cylinder", "sphere"),
    by_gjk("box", "cylinder"),
    by_gjk("cylinder", "capsule"),
    by_gjk("cylinder", "cylinder"),
    own("plane", "hull"),
    by_gjk("hull", "sphere"),
    by_gjk("box", "hull"),
    by_gjk("hull", "capsule"),
    by_gjk("hull", "cylinder"),
    by_gjk("hull", "hull"),
    own("plane", "ellipsoid"),
    smooth("sphere"),
    smooth("box"),
    smooth("capsule"),
    smooth("cylinder"),
    smooth("hull"),
    smooth("ellipsoid"),
    *(
        inside(cavity, shape, file)
        for cavity in ("bowl", "drum")
        for shape, file in (
            ("sphere", "sphere"),
            ("capsule", "capsule"),
            ("box", "box"),
            ("hull", "hull"),
            ("cylinder", "cylinder"),
            ("ellipsoid", "ellipsoid"),
            ("cone", "cone"),
        )
    ),
    *map(on_mesh, ("sphere", "box", "capsule", "cylinder", "hull", "ellipsoid", "cone")),
    own("plane", "cone"),
    own("cone", "sphere"),
    by_gjk("box", "cone"),
    by_gjk("cone", "capsule"),
    by_gjk("cone", "cylinder"),
    by_gjk("hull", "cone"),
    by_gjk("cone", "cone"),
    smooth("cone"),
)


def undeclared() -> list[ShapePair]:
    """Return the pairs of shapes that no file has, by the kernels for any convex shapes."""
    known = {frozenset(pair.shapes) for pair in DECLARED}
    names = ["plane", *(shape.name for shape in SHAPES.values() if shape.convex)]
    return [
        ShapePair(f"{b}_{a}", (a, b), "convex_plane" if a == "plane" else "convex")
        for a, b in combinations_with_replacement(names, 2)
        if {a, b} not in known and b != "plane"
    ]


# By name. The order is that of reports, and numbers the pairs in the engine's tables.
SHAPE_PAIRS = numbered(*DECLARED, *undeclared())
