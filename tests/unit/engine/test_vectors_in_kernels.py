"""Vectors in kernels are those of numpy, component by component."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from interpreted import interpreted
from single_bodies import body, row

from lavendersim.engine import vectors
from lavendersim.engine.vectors import Vec3


@pytest.fixture
def ab(rng) -> np.ndarray:
    return rng.normal(size=(2, 3))


def test_sums_and_multiples(ab) -> None:
    a, b = (Vec3(*v) for v in ab)
    for kernel, arguments, expected in (
        (vectors.plus, (a, b), ab[0] + ab[1]),
        (vectors.minus, (a, b), ab[0] - ab[1]),
        (vectors.plus_scaled, (a, 0.7, b), ab[0] + 0.7 * ab[1]),
        (vectors.scaled, (0.7, a), 0.7 * ab[0]),
        (vectors.divided, (a, 0.7), ab[0] / 0.7),
        (vectors.negative, (a,), -ab[0]),
    ):
        np.testing.assert_array_equal(interpreted(kernel)(*arguments), expected)


def test_products_and_lengths(ab) -> None:
    a, b = (Vec3(*v) for v in ab)
    assert interpreted(vectors.dot)(a, b) == pytest.approx(ab[0] @ ab[1], abs=1e-15)
    np.testing.assert_allclose(interpreted(vectors.cross)(a, b), np.cross(*ab), atol=1e-15)
    assert interpreted(vectors.length)(a) == pytest.approx(np.linalg.norm(ab[0]), rel=1e-15)


def test_vectors_are_read_from_records_and_arrays(ab) -> None:
    rows = body("sphere", (1, 0, 0), ab[0])
    np.testing.assert_array_equal(interpreted(vectors.position)(row(rows)), ab[0])
    np.testing.assert_array_equal(interpreted(vectors.vector_of)(ab[1]), ab[1])
    np.testing.assert_array_equal(interpreted(vectors.vector_at)(ab, 1), ab[1])


def test_across_is_at_right_angles_to_v_and_to_the_axis_of_its_smallest_component(rng) -> None:
    for v in (*np.eye(3), *rng.normal(size=(30, 3))):
        found = np.array(interpreted(vectors.across)(Vec3(*v)))
        smallest = np.argmin(np.abs(v))
        assert abs(found @ v) < 1e-15 * (v @ v)
        assert found[smallest] == 0.0
        assert np.linalg.norm(found) == pytest.approx(
            np.linalg.norm(np.delete(v, smallest)), rel=1e-15
        )


def test_a_body_turns_vectors_by_its_matrix_and_back(rng, ab) -> None:
    matrix = convex.random_rotation(rng)
    rows, v = row(body("box", (1, 1, 1), matrix=matrix)), Vec3(*ab[0])
    np.testing.assert_allclose(interpreted(vectors.from_body)(rows, v), matrix @ ab[0], atol=1e-15)
    np.testing.assert_allclose(
        interpreted(vectors.into_body)(rows, v), matrix.T @ ab[0], atol=1e-15
    )
