"""Every point lies half way between two surfaces, on a unit normal that leads from A to B.

`p - phi/2 n` is a point of A's surface and `p + phi/2 n` one of B's, for every point of a manifold.
"""

from __future__ import annotations

import numpy as np
import pytest
from shape_pairs import ALL, CUT, ROUND_OFF, random_poses

from lavendersim.engine.records import TOUCHING


@pytest.mark.parametrize("pair", ALL)
def test_both_surfaces_are_half_a_separation_away_along_the_normal(pair):
    seen = random_poses(pair)
    for manifold, off_a, off_b in zip(seen.found, seen.off_first, seen.off_second, strict=True):
        for point, phi in zip(manifold.points, manifold.phi, strict=True):
            on_a, on_b = point - 0.5 * phi * manifold.normal, point + 0.5 * phi * manifold.normal
            assert off_a(on_a) <= CUT + ROUND_OFF
            assert off_b(on_b) <= CUT + ROUND_OFF


@pytest.mark.parametrize("pair", ALL)
def test_normals_are_unit_and_moving_b_along_them_separates(pair):
    seen = random_poses(pair)
    for first, second, manifold in zip(seen.first, seen.second, seen.found, strict=True):
        if len(manifold.phi):
            assert np.linalg.norm(manifold.normal) == pytest.approx(1.0, abs=4e-15)
            if pair.endswith("plane"):
                outward = np.array([first["hx"], first["hy"], first["hz"]])
                np.testing.assert_array_equal(manifold.normal, outward)
            else:
                apart = [second[k] - first[k] for k in "xyz"]
                assert manifold.normal @ apart >= -ROUND_OFF


@pytest.mark.parametrize("pair", ALL)
def test_a_manifold_has_at_most_four_points_with_names_of_their_own(pair):
    for manifold in random_poses(pair).found:
        assert len(manifold.phi) <= (4 if pair.startswith("box") else 1)
        assert len(set(manifold.feature)) == len(manifold.feature)
        assert (manifold.phi <= TOUCHING).all()
