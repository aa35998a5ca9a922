"""Rotations of arrays are those of plain floats, and both are rotations."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.geometry import quaternions
from lavendersim.geometry.rotations import (
    frame_along,
    products,
    rotated,
    rotation_matrices,
    rotation_matrix,
    shortest_turn,
    turns_between,
    unit_quaternion,
)
from lavendersim.geometry.vectors import unit

RANDOM = np.random.default_rng(11).normal(size=(20, 4))


def test_a_matrix_has_the_axes_of_its_quaternion_as_columns() -> None:
    for row in RANDOM:
        q = unit(tuple(row.tolist()))
        np.testing.assert_array_equal(rotation_matrix(q), np.array(quaternions.axes(q)).T)


def test_a_matrix_turns_and_does_not_stretch() -> None:
    for matrix in rotation_matrices(RANDOM):
        # a few dozen products of numbers below 1
        np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=2e-15)
        assert np.linalg.det(matrix) == pytest.approx(1.0, abs=2e-15)


def test_many_matrices_are_those_of_the_single_quaternions() -> None:
    single = [rotation_matrix(unit_quaternion(row)) for row in RANDOM]
    # two ways to sum four squares differ by a rounding
    np.testing.assert_allclose(rotation_matrices(RANDOM), single, atol=2e-15)


def test_a_quarter_turn_about_z_takes_x_to_y() -> None:
    quarter = np.sqrt([0.5, 0.0, 0.0, 0.5])
    np.testing.assert_allclose(rotation_matrix(quarter) @ [1, 0, 0], [0, 1, 0], atol=4e-16)
    np.testing.assert_allclose(rotated(quarter, np.eye(3)[0]), [0, 1, 0], atol=4e-16)


def test_a_third_of_a_turn_about_the_diagonal_permutes_the_axes() -> None:
    turned = rotated(np.full(4, 0.5), np.eye(3))
    np.testing.assert_allclose(turned, np.eye(3)[[1, 2, 0]], atol=1e-16)


def test_a_product_turns_as_its_factors_one_after_the_other() -> None:
    one, other = RANDOM[:10], RANDOM[10:]
    both = rotation_matrices(one) @ rotation_matrices(other)
    # some forty roundings of numbers below 1, beside those of bringing to unit length
    np.testing.assert_allclose(rotation_matrices(products(one, other)), both, atol=1e-14)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_turn_between_two_orientations_leads_from_one_to_the_other(sign: float) -> None:
    """And by no more than half a turn: q and -q are one orientation."""
    before = RANDOM[:10] / np.linalg.norm(RANDOM[:10], axis=1)[:, None]
    after = sign * RANDOM[10:] / np.linalg.norm(RANDOM[10:], axis=1)[:, None]
    cosine, sine = turns_between(before, after)
    assert np.all(cosine >= 0.0)
    for k in range(10):
        turn = np.array([cosine[k], *sine[k]])
        turned = rotation_matrix(turn) @ rotation_matrix(before[k])
        # a few dozen products of numbers below 1
        np.testing.assert_allclose(turned, rotation_matrix(after[k]), atol=3e-15)


def test_vectors_turn_as_by_the_matrix() -> None:
    vectors = np.random.default_rng(1).normal(size=(5, 3))
    for row in RANDOM:
        q = unit_quaternion(row)
        turned = vectors @ rotation_matrix(q).T
        np.testing.assert_allclose(rotated(q, vectors), turned, atol=1e-14)


def test_product_does_the_second_rotation_first() -> None:
    one, other = unit_quaternion(RANDOM[0]), unit_quaternion(RANDOM[1])
    together = rotation_matrix(quaternions.product(tuple(one.tolist()), tuple(other.tolist())))
    np.testing.assert_allclose(together, rotation_matrix(one) @ rotation_matrix(other), atol=1e-15)


SLOPE = (-0.5, 0.0, np.sqrt(0.75))


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), SLOPE])
def test_the_shortest_turn_takes_z_to_the_direction(direction: tuple[float, ...]) -> None:
    turn = shortest_turn(np.array(direction, float))
    # the half-angle formula loses 1 + cos to cancellation: 1e-12 there is 1e-6 at worst
    np.testing.assert_allclose(rotation_matrix(turn)[:, 2], direction, atol=1e-14)


def test_a_frame_along_a_direction_is_right_handed() -> None:
    for direction in (*np.eye(3), *-np.eye(3), np.array([0.6, 0.0, 0.8])):
        turn = frame_along(direction)
        np.testing.assert_allclose(turn[:, 2], direction, atol=1e-16)
        np.testing.assert_allclose(turn.T @ turn, np.eye(3), atol=4e-16)
        assert np.linalg.det(turn) == pytest.approx(1.0)
