"""The matrices of Newton's method for a spring, against numpy and central differences."""

from __future__ import annotations

import numpy as np

from lavendersim.engine.compile import inner
from lavendersim.engine.spec import Spec
from lavendersim.engine.spring_newton import (
    Mat3,
    crossing,
    diagonal,
    make_mean_lever,
    outer,
    product,
    solution,
    solutions,
    sum_of,
    times,
)
from lavendersim.engine.vectors import Vec3

MEAN_LEVER = make_mean_lever(Spec(("rotation",)))


@inner
def vector(a):
    return Vec3(a[0], a[1], a[2])


@inner
def matrix(a):
    return Mat3(vector(a[:, 0]), vector(a[:, 1]), vector(a[:, 2]))


@inner
def put(out, v):
    out[0], out[1], out[2] = v.x, v.y, v.z


@inner
def put_matrix(out, m):
    put(out[:, 0], m.x)
    put(out[:, 1], m.y)
    put(out[:, 2], m.z)


# Results go into arrays: tuples of tuples are not handed to Python.
@inner
def put_lever(arm, by_a, r, a):
    found, derivative = MEAN_LEVER(vector(r), vector(a))
    put(arm, found)
    put_matrix(by_a, derivative)


@inner
def put_results(vectors, matrices, m, n, v, w):
    one, other, a, b = matrix(m), matrix(n), vector(v), vector(w)
    put(vectors[0], times(one, a))
    put(vectors[1], solution(one, a))
    put_matrix(matrices[0], product(one, other))
    put_matrix(matrices[1], solutions(one, other))
    put_matrix(matrices[2], sum_of(one, 0.3, other))
    put_matrix(matrices[3], crossing(2.0, a))
    put_matrix(matrices[4], outer(a, b))
    put_matrix(matrices[5], diagonal(1.5))


def lever_and_derivative(r: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    arm, by_a = np.zeros(3), np.zeros((3, 3))
    put_lever(arm, by_a, r, a)
    return arm, by_a


def test_products_and_solutions_are_those_of_numpy(rng: np.random.Generator) -> None:
    for _ in range(20):
        m, n = rng.normal(size=(2, 3, 3)) + 3.0 * np.eye(3)
        v, w = rng.normal(size=(2, 3))
        vectors, matrices = np.zeros((2, 3)), np.zeros((6, 3, 3))
        put_results(vectors, matrices, m, n, v, w)
        # Matrices of condition below some hundred, a few roundings.
        np.testing.assert_allclose(vectors, (m @ v, np.linalg.solve(m, v)), atol=1e-12)
        cross = np.cross(np.eye(3), -v).T
        np.testing.assert_allclose(cross @ w, np.cross(v, w), atol=1e-15)
        expected = (m @ n, np.linalg.solve(m, n), m + 0.3 * n, 2.0 * cross)
        expected += (np.outer(v, w), 1.5 * np.eye(3))
        np.testing.assert_allclose(matrices, expected, atol=1e-12)


def test_mean_lever_is_half_way_and_its_derivative_is_its_difference(
    rng: np.random.Generator,
) -> None:
    step = 1e-5
    for _ in range(20):
        r, a = rng.normal(size=(2, 3))
        arm, by_a = lever_and_derivative(r, a)
        # Cayley's map: r_1 - r_0 = 2 a x r_m.
        np.testing.assert_allclose(arm - r, np.cross(a, arm), atol=1e-15)
        for axis in range(3):
            offset = np.zeros(3)
            offset[axis] = step
            more, _ = lever_and_derivative(r, a + offset)
            less, _ = lever_and_derivative(r, a - offset)
            # h^2/6 of a third derivative below some ten; round-off 1e-16/h.
            slope = (more - less) / (2.0 * step)
            np.testing.assert_allclose(by_a[:, axis], slope, atol=1e-9)
