"""A cone touches a plane by its base, along its side, with its rim or with its apex."""

from __future__ import annotations

import math

import convex
import numpy as np
import pytest
import solids
from scipy.spatial.transform import Rotation
from single_bodies import body, manifold, solid

N = np.array([2.0, -1.0, 2.0]) / 3.0
OFFSET = 0.4
GROUND = body("plane", (0, 0, 1))
RADIUS, BASE = 0.3, 0.1  # its height is 4 BASE [m]
HALF = math.atan(RADIUS / (4.0 * BASE))
ROUND_OFF = 1e-15


def standing(turn: Rotation, centre):
    return body("cone", (RADIUS, 0.0, BASE), centre, turn.as_matrix())


def test_the_least_point_is_half_way_between_plane_and_surface(rng) -> None:
    for _ in range(40):
        half, matrix = rng.uniform(0.1, 0.8, 3), convex.random_rotation(rng)
        centre = rng.normal(size=3)
        b = body("cone", half, centre, matrix)
        found = manifold("cone_plane", body("plane", N, offset=OFFSET), b, 10.0)
        least = int(found.phi.argmin())
        local = -matrix.T @ N
        # The support of the apex and of the rim.
        reach = max(
            3.0 * half[2] * local[2], half[0] * math.hypot(local[0], local[1]) - half[2] * local[2]
        )
        assert found.phi[least] == pytest.approx(N @ centre - OFFSET - reach, abs=8 * ROUND_OFF)
        for point, phi in zip(found.points, found.phi, strict=True):
            assert point @ N == pytest.approx(OFFSET + 0.5 * phi, abs=8 * ROUND_OFF)
            assert abs(solids.off_surface(solid(b), point + 0.5 * phi * N)) < 1e-14


@pytest.mark.parametrize("azimuth", [0.0, 0.7, 2.0, 5.5])
def test_on_its_side_it_touches_at_its_apex_and_its_rim(azimuth: float) -> None:
    turn = Rotation.from_euler("ZY", [azimuth, -(0.5 * math.pi + HALF)])
    centre = turn.apply([0.0, 0.0, -3.0 * BASE])  # the apex in the origin
    found = manifold("cone_plane", GROUND, standing(turn, centre), 1e-6)
    assert sorted(found.feature) == [8, 9]
    assert found.phi == pytest.approx([0.0, 0.0], abs=ROUND_OFF)
    ends = found.points[np.argsort(found.feature)]
    slant = math.hypot(RADIUS, 4.0 * BASE)
    along = [slant * math.cos(azimuth), slant * math.sin(azimuth), 0.0]
    np.testing.assert_allclose(ends, [along, [0.0, 0.0, 0.0]], atol=ROUND_OFF)


def test_on_its_base_it_touches_at_four_points_of_its_rim() -> None:
    found = manifold("cone_plane", GROUND, standing(Rotation.identity(), (0, 0, BASE)), 1e-6)
    assert len(found.phi) == 4
    assert found.phi == pytest.approx([0.0] * 4, abs=ROUND_OFF)
    out = np.linalg.norm(found.points[:, :2], axis=1)
    assert out == pytest.approx([RADIUS] * 4, abs=ROUND_OFF)


@pytest.mark.parametrize("tilt", [0.0, 0.3])
def test_on_its_tip_it_touches_with_its_apex(tilt: float) -> None:
    turn = Rotation.from_euler("y", math.pi - tilt)
    centre = turn.apply([0.0, 0.0, -3.0 * BASE])
    found = manifold("cone_plane", GROUND, standing(turn, centre), 1e-6)
    assert list(found.feature) == [9]
    np.testing.assert_allclose(found.points, [[0.0, 0.0, 0.0]], atol=ROUND_OFF)


def test_beyond_the_margin_there_is_none() -> None:
    for gap, count in ((0.099, 4), (0.101, 0), (2.0, 0)):
        b = standing(Rotation.identity(), (0, 0, BASE + gap))
        assert len(manifold("cone_plane", GROUND, b, 0.1).phi) == count
