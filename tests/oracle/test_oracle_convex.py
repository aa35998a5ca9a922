"""The slow separation of two boxes is bounded by two methods that know nothing of axes."""

from __future__ import annotations

import convex
import numpy as np


def pairs(count: int):
    rng = np.random.default_rng(3)
    for _ in range(count):
        halves = np.exp(rng.uniform(-2.0, 0.0, (2, 3)))
        centre = rng.normal(size=3)
        a = convex.Box(np.zeros(3), convex.random_rotation(rng), halves[0])
        b = convex.Box(centre, convex.random_rotation(rng), halves[1])
        yield a, b


def test_no_direction_separates_two_boxes_more_than_the_candidate_axes():
    directions = np.random.default_rng(4).normal(size=(4000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    for a, b in pairs(60):
        found = convex.box_box_separation(a, b)
        # Among overlapping boxes the candidates are all that counts; apart, a vertex pair may win.
        if found < 0.0:
            assert convex.gap_along(a, b, directions).max() <= found + 1e-12


def test_alternating_projections_agree_on_whether_two_boxes_overlap():
    seen = set()
    for a, b in pairs(60):
        found = convex.box_box_separation(a, b)
        distance = convex.box_box_distance(a, b)
        seen.add(found > 0.0)
        if found > 0.0:
            assert distance >= found - 1e-12
        elif found < -0.02:
            # Projections between overlapping sets with an inner ball converge geometrically.
            assert distance < 1e-9
    assert seen == {True, False}


def test_a_quaternion_and_its_matrix_turn_a_quarter_the_right_way():
    quarter = convex.matrix_of([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    np.testing.assert_allclose(quarter @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-15)
