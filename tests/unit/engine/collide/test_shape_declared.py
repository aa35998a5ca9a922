"""Which shapes are convex, how bodies number them, and which kernels their files have."""

from __future__ import annotations

from importlib import import_module

from lavendersim.engine.collide.shape import MAKERS, Shape
from lavendersim.engine.collide.shapes import SHAPES


def test_what_has_a_support_or_a_radius_is_convex_and_nothing_else() -> None:
    assert not Shape("whatever").convex
    assert Shape("grown", rounded=True).convex
    assert Shape("core", kernels=True).convex
    convex = {name for name, shape in SHAPES.items() if shape.convex}
    assert convex == {"sphere", "box", "capsule", "cylinder", "hull", "ellipsoid", "cone"}


def test_a_file_of_a_shape_defines_no_maker_that_nobody_asks_for() -> None:
    """One that is called otherwise by mistake would be taken for one that is not there."""
    for shape in (one for one in SHAPES.values() if one.kernels):
        file = import_module(f"lavendersim.engine.collide.shapes.{shape.name}")
        assert {name for name in vars(file) if name.startswith("make_")} <= {*MAKERS}
        assert shape.maker("make_support") is file.make_support
    assert Shape("plane").maker("make_support") is None


def test_kinds_are_the_numbers_in_bodies_and_all_different() -> None:
    kinds = [shape.kind for shape in SHAPES.values()]
    assert sorted(kinds) == list(range(len(kinds)))
    assert [SHAPES[name].kind for name in ("plane", "sphere", "box")] == [0, 1, 2]
