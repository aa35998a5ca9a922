"""A sphere's distance from a cone is its centre's: of side, base, rim or apex."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from single_bodies import body, manifold

# Half of it is the triangle of (0.3, -0.1), (0, 0.3) and the axis; its side's normal is (4, 3)/5.
R, RADIUS, BASE = 0.2, 0.3, 0.1
OUT = np.array([0.8, 0.6])


@pytest.mark.parametrize(
    ("foot", "out", "distance"),
    [
        ((0.15, 0.1), OUT, 0.2),  # beside the side
        ((0.15, 0.1), OUT, -0.03),  # inside, the side is nearer
        ((0.1, -BASE), (0.0, -1.0), 0.5),  # below the base
        ((0.02, -BASE), (0.0, -1.0), -0.02),  # inside, the base is nearer
        ((RADIUS, -BASE), (0.6, -0.8), 0.5),  # off the rim, below the base
        ((RADIUS, -BASE), (0.96, 0.28), 0.5),  # off the rim, above it: before the side's normal
        ((0.0, 0.3), (0.28, 0.96), 0.4),  # off the apex, behind the side's normal
    ],
)
def test_side_base_rim_and_apex(foot, out, distance: float, rng) -> None:
    matrix, angle = convex.random_rotation(rng), rng.uniform(0.0, 6.0)
    radial, up = np.array([np.cos(angle), np.sin(angle), 0.0]), np.array([0.0, 0.0, 1.0])
    centre = np.array([0.3, 0.2, 0.1])
    n = matrix @ (out[0] * radial + out[1] * up)
    place = centre + matrix @ (foot[0] * radial + foot[1] * up) + distance * n
    a = body("cone", (RADIUS, 0.0, BASE), centre, matrix)
    found = manifold("sphere_cone", a, body("sphere", (R, 0, 0), place), 1.0)
    assert found.phi == pytest.approx([distance - R], abs=1e-14)
    np.testing.assert_allclose(found.normal, n, atol=1e-14)
    np.testing.assert_allclose(found.points[0], place - 0.5 * (R + distance) * n, atol=1e-14)


def test_on_the_axis_the_side_is_left_along_x_and_beyond_the_margin_there_is_none() -> None:
    a = body("cone", (RADIUS, 0.0, BASE))
    found = manifold("sphere_cone", a, body("sphere", (R, 0, 0), (0, 0, 0.25)))
    np.testing.assert_allclose(found.normal, (0.8, 0.0, 0.6), atol=1e-15)
    for gap, count in ((0.099, 1), (0.101, 0)):
        for place in ((0.0, 0.0, 0.3 + R + gap), (0.0, 0.0, -(BASE + R + gap))):
            sphere = body("sphere", (R, 0, 0), place)
            assert len(manifold("sphere_cone", a, sphere, 0.1).phi) == count
