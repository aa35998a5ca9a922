"""Which shapes are convex, and what a shape that says nothing is taken for."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from single_bodies import body, row, scratch_of, spec_of

from lavendersim.engine.collide.shape import Shape
from lavendersim.engine.collide.shapes import (
    SHAPES,
    make_best_face,
    make_half_extents,
    make_is_curved,
    make_is_polyhedral,
    make_radius,
    make_support,
)
from lavendersim.engine.vectors import Vec3


def test_what_has_a_support_or_a_radius_is_convex_and_nothing_else() -> None:
    def maker(spec):
        return None

    assert not Shape("whatever").convex
    assert Shape("grown", rounded=True).convex
    assert Shape("core", make_support=maker).convex
    convex = {name for name, shape in SHAPES.items() if shape.convex}
    assert convex == {"sphere", "box", "capsule", "cylinder", "hull"}


def test_kinds_are_the_numbers_in_bodies_and_all_different() -> None:
    kinds = [shape.kind for shape in SHAPES.values()]
    assert sorted(kinds) == list(range(len(kinds)))
    assert [SHAPES[name].kind for name in ("plane", "sphere", "box")] == [0, 1, 2]


@pytest.mark.parametrize(
    ("kind", "radius", "curved", "polyhedral"),
    [("sphere", 0.4, False, False), ("box", 0.0, False, True), ("cylinder", 0.0, True, False)],
)
def test_kernels_ask_the_shape_of_the_body(kind, radius, curved, polyhedral) -> None:
    spec, a = spec_of("sphere_box", "cylinder_box", "sphere_cylinder"), body(kind, (0.4, 0.4, 0.4))
    assert interpreted(make_radius(spec))(row(a)) == radius
    assert interpreted(make_is_curved(spec))(row(a)) is curved
    assert interpreted(make_is_polyhedral(spec))(row(a)) is polyhedral


def test_a_shape_without_kernels_is_its_centre_its_bounding_sphere_and_no_face() -> None:
    spec, ball, hulls = spec_of("sphere_box"), body("sphere", (0.4, 0, 0)), scratch_of([]).hulls
    n = Vec3(1.0, 0.0, 0.0)
    assert tuple(interpreted(make_support(spec))(row(ball), n, hulls)) == (0.0, 0.0, 0.0)
    assert tuple(interpreted(make_half_extents(spec))(row(ball))) == (0.4, 0.4, 0.4)
    assert interpreted(make_best_face(spec))(row(ball), n, hulls)[0] == -1
    assert interpreted(make_best_face(spec))(row(body("box", (1, 1, 1))), n, hulls)[0] >= 0
