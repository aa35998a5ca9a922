"""Two spheres touch on the line of their centres: phi = |x_b - x_a| - r_a - r_b."""

from __future__ import annotations

import numpy as np
import pytest
from single_bodies import body, manifold

R_A, R_B = 0.3, 0.5


def at(centre, margin: float = 10.0, start=(0.1, -0.2, 0.3)):
    a = body("sphere", (R_A, 0, 0), start)
    return manifold("sphere_sphere", a, body("sphere", (R_B, 0, 0), np.add(start, centre)), margin)


@pytest.mark.parametrize("distance", [0.1, 0.8, 1.3])
def test_the_point_lies_half_way_between_the_surfaces(distance: float) -> None:
    n = np.array([2.0, -3.0, 6.0]) / 7.0
    found = at(distance * n)
    np.testing.assert_allclose(found.normal, n, atol=1e-15)
    assert found.phi == pytest.approx([distance - R_A - R_B], abs=1e-15)
    # A's surface at 0.3 n, B's at (distance - 0.5) n, from A's centre
    middle = np.array([0.1, -0.2, 0.3]) + 0.5 * (R_A + distance - R_B) * n
    np.testing.assert_allclose(found.points[0], middle, atol=1e-15)


def test_one_centre_is_parted_along_z_and_what_is_far_has_no_point() -> None:
    found = at((0.0, 0.0, 0.0))
    np.testing.assert_array_equal(found.normal, (0.0, 0.0, 1.0))
    assert found.phi == pytest.approx([-0.8], abs=1e-15)
    assert len(at((0.0, 0.899, 0.0), 0.1).phi) == 1
    assert len(at((0.0, 0.901, 0.0), 0.1).phi) == 0
