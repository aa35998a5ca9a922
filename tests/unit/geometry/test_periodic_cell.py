"""Places in a periodic cell: by whole periods into it, or to what is nearest."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from lavendersim.geometry.periodic_cell import (
    bounds_with_cell,
    edges_of_cell,
    faces_of_cell,
    in_cell,
    nearest_images,
    wrapped,
)

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


LOW, HIGH = np.array([-0.5, -3.0, 0.25]), np.array([2.0, 5.0, 0.375])


def test_bounds_hold_the_ends_of_the_cell() -> None:
    low, high = bounds_with_cell(LOW, HIGH, CELL)
    np.testing.assert_array_equal([low, high], [[-1.0, -3.0, 0.0], [2.0, 5.0, 0.5]])
    np.testing.assert_array_equal(LOW, [-0.5, -3.0, 0.25])  # they are left as they are


def test_the_edges_of_the_cell_go_from_corner_to_corner_once() -> None:
    """Twelve: four along each axis, as long as the cell is, or the bounds where it is open."""
    edges = edges_of_cell(LOW, HIGH, CELL)
    assert len(np.unique(edges.reshape(12, 6), axis=0)) == 12
    lengths = [np.sort(np.abs(b - a)).tolist() for a, b in edges]
    assert sorted(lengths) == sorted([[0.0, 0.0, one] for one in (2.0, 8.0, 0.5) for _ in range(4)])
    corners, counts = np.unique(edges.reshape(24, 3), axis=0, return_counts=True)
    assert (counts == 3).all()
    expected = [[x, y, z] for x in (-1.0, 1.0) for y in (-3.0, 5.0) for z in (0.0, 0.5)]
    np.testing.assert_array_equal(corners, expected)
    assert edges_of_cell(LOW, HIGH, None).shape == (0, 2, 3)


def test_faces_are_the_ends_of_what_is_periodic() -> None:
    faces = [(normal.tolist(), offset) for normal, offset in faces_of_cell(CELL)]
    x, z = [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]
    assert faces == [(x, -1.0), (x, 1.0), (z, 0.0), (z, 0.5)]
    assert [*faces_of_cell(None)] == []
