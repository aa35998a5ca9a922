"""A point in a cavity is seen from the centre, in a drum from the axis."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from cavity_contacts import CENTRE, RADIUS, off
from interpreted import interpreted
from single_bodies import body, row, spec_of

from lavendersim.engine.collide.manifold.cavity_points import make_axis, make_from_centre
from lavendersim.engine.vectors import Vec3


@pytest.mark.parametrize("cavity", ["bowl", "drum"])
def test_a_point_is_seen_from_the_centre_of_a_bowl_and_from_the_axis_of_a_drum(
    cavity: str, rng
) -> None:
    spec = spec_of(f"sphere_{cavity}")
    from_centre, axis_of = interpreted(make_from_centre(spec)), interpreted(make_axis(spec))
    for _ in range(20):
        turn, p = convex.random_rotation(rng), rng.normal(size=3)
        axis = turn[:, 2] if cavity == "drum" else np.zeros(3)
        wall = row(body(cavity, (RADIUS, 0.0, 0.0), CENTRE, turn))
        np.testing.assert_array_equal(tuple(axis_of(wall)), axis)
        found = tuple(from_centre(wall, Vec3(*p)))
        np.testing.assert_allclose(found, off(p[None], axis)[0], atol=1e-15)
