"""Places in a periodic cell: by whole periods into it, or to what is nearest."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from lavendersim.geometry.periodic_cell import in_cell, nearest_images, wrapped

CELL = SimpleNamespace(x=(-1.0, 1.0), y=None, z=(0.0, 0.5))


def test_places_are_moved_into_the_cell_by_whole_periods() -> None:
    places = np.array([[0.25, 7.0, 0.25], [1.25, 7.0, -0.25], [-5.0, 0.0, 2.125], [1.0, 0.0, 0.5]])
    expected = [[0.25, 7.0, 0.25], [-0.75, 7.0, 0.25], [-1.0, 0.0, 0.125], [-1.0, 0.0, 0.0]]
    np.testing.assert_array_equal(wrapped(places, CELL), expected)
    assert places[1, 0] == 1.25  # they are left as they are
    assert wrapped(places, None) is places


def test_poses_keep_their_turns() -> None:
    poses = np.array([[[1.25, 7.0, -0.25, 1.0, 0.0, 0.0, 0.5]]])
    expected = [[[-0.75, 7.0, 0.25, 1.0, 0.0, 0.0, 0.5]]]
    np.testing.assert_array_equal(in_cell(poses, CELL), expected)
    assert in_cell(poses, None) is poses


def test_images_are_the_nearest() -> None:
    places = np.array([[0.9, 0.0, 0.1], [0.9, 3.0, 0.1]])
    others = np.array([[-0.9, 0.0, 0.4], [4.5, 0.0, 0.1]])
    expected = [[-1.1, 0.0, 0.6], [4.9, 3.0, 0.1]]
    np.testing.assert_allclose(nearest_images(places, others, CELL), expected, atol=1e-15)
    assert nearest_images(places, others, None) is places
