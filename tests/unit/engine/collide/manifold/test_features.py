"""A point keeps its name while the same vertices and faces make it; its impulse can follow."""

from __future__ import annotations

import convex
import numpy as np
import poses
import pytest

STEPS = 101


def names(pair, place):
    """The set of names at each of 101 poses `place(i) -> (centre, quaternion)` of the upper box."""
    first, second = poses.allocate(STEPS), poses.allocate(STEPS)
    for i in range(STEPS):
        centre, quaternion = place(i)
        if pair == "box_plane":
            poses.put(first[i], (0.0, 0.0, 1.0), offset=0.5)
        else:
            poses.put(first[i], (0.5, 0.5, 0.5))
        poses.put(second[i], (0.5, 0.4, 0.5), centre, convex.matrix_of(np.array(quaternion)))
    return [frozenset(manifold.feature) for manifold in poses.manifolds(pair, first, second)]


@pytest.mark.parametrize("start", [(0.0, 0.0), (0.2, 0.05), (-0.3, 0.3)])
def test_names_stay_during_a_slow_slide(start):
    # 10 um a step from just beyond the edges' own line to 1 mm.
    seen = names(
        "box_box", lambda i: ((start[0] + 1e-5 * (i + 1), start[1], 0.999), (1.0, 0.0, 0.0, 0.0))
    )
    assert len(set(seen)) == 1
    assert len(seen[0]) == 4


@pytest.mark.parametrize("pair", ["box_box", "box_plane"])
def test_names_stay_during_a_small_tilt(pair):
    # 1e-5 rad a step about a skew axis lifts a corner by 0.7 mm in all; 1 mm penetrates.
    seen = names(pair, lambda i: ((0.1, 0.05, 0.999), (1.0, 3e-6 * i, 4e-6 * i, 0.0)))
    assert len(set(seen)) == 1
    assert len(seen[0]) == 4


def test_round_off_does_not_rename_the_points_of_aligned_boxes(rng):
    noise = rng.normal(size=(STEPS, 7)) * 1e-16
    seen = names(
        "box_box",
        lambda i: (np.array([0.0, 0.0, 0.999]) + noise[i, :3], noise[i, 3:] + [1, 0, 0, 0]),
    )
    assert len(set(seen)) == 1
