"""The projection onto Coulomb's cone by its optimality, and its derivative by differences."""

from __future__ import annotations

import math

import numpy as np

from lavendersim.problems.friction_cone import derivative_root, project

RANDOM = np.random.default_rng(11)
MU = RANDOM.uniform(0.05, 2.0, 300)
Y = RANDOM.normal(size=(300, 3))


def dual_gap(x: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Return by how much x lies outside the cone |x_t| <= mu x_n."""
    return np.hypot(x[:, 1], x[:, 2]) - mu * x[:, 0]


def test_projection_is_the_nearest_point_by_moreaus_decomposition() -> None:
    """y = P(y) + (y - P(y)): in the cone, in its polar, and at right angles."""
    near = project(Y, MU)
    rest = Y - near
    assert dual_gap(near, MU).max() < 1e-15 * 10
    # The polar cone: mu |z_t| <= -z_n.
    assert (MU * np.hypot(rest[:, 1], rest[:, 2]) + rest[:, 0]).max() < 1e-14
    assert np.abs(np.einsum("ni,ni->n", near, rest)).max() < 1e-14


def test_a_point_at_hand() -> None:
    # mu = 1, y = (0, 2, 0): on the generator (1, 1, 0), halfway.
    assert project(np.array([[0.0, 2.0, 0.0]]), np.array([1.0])).tolist() == [[1.0, 1.0, 0.0]]
    inside = np.array([[2.0, 1.0, 1.0]])
    assert project(inside, np.array([1.0])).tolist() == inside.tolist()
    assert not project(np.array([[-2.0, 1.0, 1.0]]), np.array([1.0])).any()


def test_frictionless_it_is_the_positive_part_of_the_normal() -> None:
    assert project(np.array([[2.0, 3.0, 4.0]]), np.array([0.0])).tolist() == [[2.0, 0.0, 0.0]]


def test_derivative_is_that_of_the_projection() -> None:
    root = derivative_root(Y, MU)
    step = 1e-6
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        slope = (project(Y + shift, MU) - project(Y - shift, MU)) / (2.0 * step)
        made = np.einsum("nij,nj->ni", root, root[:, axis])
        # Away from the kinks: half a step's curvature h^2/|y|^2 and round-off 1e-16/h, with |y| of
        # 1e-3 at the least here.
        edge = np.abs(np.hypot(Y[:, 1], Y[:, 2]) - MU * Y[:, 0]) > 1e-5
        edge &= np.abs(MU * np.hypot(Y[:, 1], Y[:, 2]) + Y[:, 0]) > 1e-5
        assert edge.sum() > 290
        assert np.abs(made - slope)[edge].max() < 1e-6


def test_derivative_has_eigenvalues_from_0_to_1() -> None:
    root = derivative_root(Y, MU)
    values = np.linalg.eigvalsh(np.einsum("nij,nkj->nik", root, root))
    assert values.min() > -1e-14
    assert values.max() < 1.0 + 1e-14
    assert math.isclose(values.max(), 1.0)
