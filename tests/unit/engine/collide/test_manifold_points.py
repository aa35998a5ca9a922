"""Every point lies half way between two surfaces, on a unit normal that leads from A to B.

`p - phi/2 n` is a point of A's surface and `p + phi/2 n` one of B's, for every point of a manifold.
The deepest one has the true signed separation; bodies apart have no manifold. All is asked of the
same poses, whose separations an oracle takes seconds to find: in one file, and so in one process.
"""

from __future__ import annotations

import numpy as np
import pytest
from shape_pairs import ALL, CUT, ROUND_OFF, random_poses

from lavendersim.engine.collide.pairs.box_box import EDGE_SHARE, EDGE_SIZE
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


@pytest.mark.parametrize("pair", ALL)
def test_bodies_touch_exactly_when_their_separation_is_not_positive(pair):
    seen = random_poses(pair)
    touching = np.array([len(m.phi) > 0 for m in seen.found])
    assert touching[seen.separation < -ROUND_OFF].all()
    assert not touching[seen.separation > TOUCHING + ROUND_OFF].any()
    assert 400 < touching.sum() < 1800  # both cases were looked at


@pytest.mark.parametrize("pair", [pair for pair in ALL if pair != "box_box"])
def test_deepest_point_has_the_true_separation(pair):
    seen = random_poses(pair)
    for separation, manifold in zip(seen.separation, seen.found, strict=True):
        if len(manifold.phi):
            assert manifold.phi.min() == pytest.approx(separation, abs=ROUND_OFF)


def test_box_box_depth_exceeds_the_true_depth_only_where_a_face_is_kept_for_an_edge():
    """A face with separation s_f is kept while s_e <= EDGE_SHARE s_f + EDGE_SIZE h, so
    s_f >= (s_e - EDGE_SIZE h) / EDGE_SHARE with h the smallest half edge."""
    seen = random_poses("box_box")
    halves = np.array([[row[k] for k in ("hx", "hy", "hz")] for row in seen.first])
    others = np.array([[row[k] for k in ("hx", "hy", "hz")] for row in seen.second])
    smallest = np.minimum(halves.min(axis=1), others.min(axis=1))
    exact = 0
    for separation, manifold, size in zip(seen.separation, seen.found, smallest, strict=True):
        if len(manifold.phi):
            deepest = manifold.phi.min()
            assert deepest <= separation + ROUND_OFF
            assert deepest >= (separation - EDGE_SIZE * size) / EDGE_SHARE - ROUND_OFF - CUT
            exact += abs(deepest - separation) < ROUND_OFF + CUT
    assert exact > 600
