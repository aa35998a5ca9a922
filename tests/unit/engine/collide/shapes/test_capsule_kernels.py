"""A capsule's core is its axis: supports are its ends; it looks along n where it lies across."""

from __future__ import annotations

import numpy as np
from shape_laws import Seen, check_half_extents, check_support
from single_bodies import body, solid

from lavendersim.engine.collide.records import LINE, POINT
from lavendersim.engine.collide.shapes import SHAPES
from lavendersim.engine.collide.shapes.capsule import make_feature


def test_the_support_is_an_end_and_the_extents_hold_the_capsule(rng) -> None:
    check_support(SHAPES["capsule"], rng)
    check_half_extents(SHAPES["capsule"], rng)


def test_the_axis_is_a_line_up_to_a_slope_and_steeper_a_point(rng) -> None:
    a = body("capsule", (0.2, 0.0, 0.5), matrix=np.eye(3)[[1, 2, 0]])
    axis = solid(a).matrix[:, 2]
    across = np.cross(axis, rng.normal(size=3))
    across /= np.linalg.norm(across)
    for slope, kind in ((0.0, LINE), (0.29, LINE), (-0.29, LINE), (0.31, POINT), (-0.31, POINT)):
        n = slope * axis + np.sqrt(1.0 - slope * slope) * across
        seen = Seen(make_feature, a, n)
        assert seen.feature.kind == kind
        if kind == LINE:
            np.testing.assert_allclose(seen.corners, [[0, 0, -0.5], [0, 0, 0.5]], atol=1e-15)


def test_without_length_it_is_a_point() -> None:
    assert Seen(make_feature, body("capsule", (0.2, 0.0, 0.0)), np.eye(3)[0]).feature.kind == POINT
