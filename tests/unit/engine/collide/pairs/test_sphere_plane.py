"""A sphere touches a plane in one point, under its centre: phi = n . x - offset - r."""

from __future__ import annotations

import numpy as np
import pytest
from single_bodies import body, manifold

N, OFFSET, R = np.array([2.0, -1.0, 2.0]) / 3.0, 0.7, 0.4


@pytest.mark.parametrize("phi", [-0.5, -1e-3, 0.0, 0.2])
def test_the_point_lies_half_way_between_sphere_and_plane(phi: float, rng) -> None:
    beside = np.cross(N, rng.normal(size=3))
    centre = (OFFSET + R + phi) * N + beside
    found = manifold(
        "sphere_plane", body("plane", N, offset=OFFSET), body("sphere", (R, 0, 0), centre), 0.3
    )
    assert found.phi == pytest.approx([phi], abs=1e-15)
    np.testing.assert_array_equal(found.normal, N)
    np.testing.assert_allclose(found.points[0], (OFFSET + 0.5 * phi) * N + beside, atol=1e-15)


def test_beyond_the_margin_there_is_none() -> None:
    plane = body("plane", (0.0, 0.0, 1.0), offset=0.5)
    for height, count in ((0.999, 1), (1.001, 0)):
        assert (
            len(
                manifold(
                    "sphere_plane", plane, body("sphere", (0.4, 0, 0), (5, 5, height)), 0.1
                ).phi
            )
            == count
        )
