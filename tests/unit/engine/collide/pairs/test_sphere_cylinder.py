"""A sphere's distance from a cylinder is its centre's: of side, cap or rim; inside, the nearer."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from single_bodies import body, manifold, solid

R, RADIUS, HALF = 0.2, 0.4, 0.6


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(
    ("across", "height", "distance", "turned"),
    [
        (0.9, 0.1, 0.5, (1.0, 0.0)),  # beside the side
        (0.1, 1.0, 0.4, (0.0, 1.0)),  # over the cap
        (0.7, 1.0, 0.5, (0.6, 0.8)),  # off the rim: 0.3 and 0.4 m
        (0.3, 0.1, -0.1, (1.0, 0.0)),  # inside, the side is nearer
        (0.1, 0.5, -0.1, (0.0, 1.0)),  # inside, the cap is nearer
    ],
)
def test_side_cap_and_rim(across, height, distance, turned, side, rng) -> None:
    matrix, angle = convex.random_rotation(rng), rng.uniform(0.0, 6.0)
    radial = np.array([np.cos(angle), np.sin(angle), 0.0])
    local = across * radial + [0.0, 0.0, side * height]
    n = matrix @ (turned[0] * radial + [0.0, 0.0, side * turned[1]])
    a = body("cylinder", (RADIUS, 0.0, HALF), (0.3, 0.2, 0.1), matrix)
    place = np.array([0.3, 0.2, 0.1]) + matrix @ local
    found = manifold("sphere_cylinder", a, body("sphere", (R, 0, 0), place), 1.0)
    assert found.phi == pytest.approx([distance - R], abs=1e-14)
    np.testing.assert_allclose(found.normal, n, atol=1e-14)
    np.testing.assert_allclose(found.points[0], place - 0.5 * (R + distance) * n, atol=1e-14)


def test_drawn_poses_have_the_oracles_distance(rng) -> None:
    for _ in range(60):
        a = body("cylinder", (RADIUS, 0.0, HALF), rng.normal(size=3), convex.random_rotation(rng))
        place = solid(a).centre + 0.6 * rng.normal(size=3)
        found = manifold("sphere_cylinder", a, body("sphere", (R, 0, 0), place), 10.0)
        assert found.phi == pytest.approx([solids.off_surface(solid(a), place) - R], abs=1e-14)


def test_on_the_axis_the_side_is_left_along_x_and_beyond_the_margin_there_is_none() -> None:
    a = body("cylinder", (RADIUS, 0.0, HALF))
    found = manifold("sphere_cylinder", a, body("sphere", (R, 0, 0), (0, 0, 0.1)))
    np.testing.assert_array_equal(found.normal, (1.0, 0.0, 0.0))
    for gap, count in ((0.099, 1), (0.101, 0)):
        place = (0.0, 0.0, -(HALF + R + gap))
        assert (
            len(manifold("sphere_cylinder", a, body("sphere", (R, 0, 0), place), 0.1).phi) == count
        )
