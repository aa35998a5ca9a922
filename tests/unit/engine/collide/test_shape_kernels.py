"""Kernels ask the shape of a body, and one that says nothing is taken for its centre."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from single_bodies import body, row, scratch_of, spec_of

from lavendersim.engine.collide.shape_kernels import (
    make_best_face,
    make_half_extents,
    make_is_curved,
    make_is_polyhedral,
    make_radius,
    make_support,
)
from lavendersim.engine.vectors import Vec3


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
