"""Exchanging two bodies of one shape turns the normal round and changes nothing else."""

from __future__ import annotations

import numpy as np
import poses
import pytest
from shape_pairs import CUT, ROUND_OFF, random_poses


@pytest.mark.parametrize("pair", ["sphere_sphere", "box_box"])
def test_swapped_bodies_touch_in_the_same_points(pair):
    seen = random_poses(pair)
    swapped = poses.manifolds(pair, seen.second, seen.first)
    for one, other in zip(seen.found, swapped, strict=True):
        assert len(one.phi) == len(other.phi)
        if len(one.phi):
            np.testing.assert_allclose(other.normal, -one.normal, atol=ROUND_OFF)
            for point, phi in zip(one.points, one.phi, strict=True):
                distance = np.linalg.norm(other.points - point, axis=1)
                twin = int(np.argmin(distance))
                # The other box may be the reference, so each cut may reach out on its own side.
                assert distance[twin] < 2.0 * CUT + ROUND_OFF
                assert other.phi[twin] == pytest.approx(phi, abs=2.0 * CUT + ROUND_OFF)
