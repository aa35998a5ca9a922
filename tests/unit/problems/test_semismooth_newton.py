"""Newton's pieces: the cone's derivative, the scaled problem, a factor and full steps."""

from __future__ import annotations

import numpy as np
import pytest
from contact_problems import HARD, heap, in_units, stack
from gauss_seidel import dense
from made_problems import random_problem

from lavendersim.problems.budget import Budget
from lavendersim.problems.factorise import factorise
from lavendersim.problems.friction_cone import derivative_root, project
from lavendersim.problems.residual import project_on_cone, residual
from lavendersim.problems.scaled_problem import (
    from_impulses,
    scale,
    scaled_residual,
    to_impulses,
    velocities,
)
from lavendersim.problems.semismooth_newton import iterate_at, newton_steps
from lavendersim.problems.solve import solve

EPS = np.finfo(float).eps


def points(seed: int, count: int = 300) -> tuple[np.ndarray, np.ndarray]:
    """Return points about cones, with some frictionless ones and some on the axis."""
    rng = np.random.default_rng(seed)
    y, mu = rng.normal(size=(count, 3)), rng.uniform(0.0, 2.0, count)
    mu[::7] = 0.0
    y[::5, 1:] = 0.0
    return y, mu


def test_the_projection_is_the_one_that_judges() -> None:
    y, mu = points(1)
    # Both are a dozen operations on numbers of some units.
    np.testing.assert_allclose(project(y, mu), project_on_cone(y, mu), atol=50.0 * EPS)


def test_the_derivative_is_that_of_the_projection() -> None:
    """Central differences at points that stay in their region: curvature is 1 / |y_t| at most."""
    y, mu = points(2)
    h = 1e-6
    side = np.hypot(y[:, 1], y[:, 2])
    clear = (np.abs(side - mu * y[:, 0]) > 0.1) & (np.abs(mu * side + y[:, 0]) > 0.1)
    clear &= (side > 0.1) | (side == 0.0) & (y[:, 0] < 0.0)
    y, mu = y[clear], mu[clear]
    assert len(mu) > 150
    root = derivative_root(y, mu)
    for axis in range(3):
        step = h * np.eye(3)[axis]
        slope = (project(y + step, mu) - project(y - step, mu)) / (2.0 * h)
        # Error h^2 / 0.1^2 of the third derivative, and eps / h of the difference.
        expected = np.einsum("nij,nj->ni", root, root[:, axis])
        np.testing.assert_allclose(expected, slope, atol=10.0 * (1e2 * h * h + EPS / h))


def test_columns_of_the_root_are_orthogonal_and_no_longer_than_one() -> None:
    """The reduced system takes the squares of their lengths for the eigenvalues of P'."""
    root = derivative_root(*points(3))
    inner = np.einsum("nij,nik->njk", root, root)
    lengths = np.einsum("njj->nj", inner)
    assert (lengths <= 1.0 + 4.0 * EPS).all()
    off = inner - np.einsum("nj,jk->njk", lengths, np.eye(3))
    assert np.abs(off).max() <= 8.0 * EPS


@pytest.mark.parametrize("units", [(1.0, 1.0), (1e4, 1e-3), (1e-6, 1e5)])
def test_the_scaled_problem_is_the_given_one_without_units(units: tuple[float, float]) -> None:
    problem = in_units(random_problem(4, 9), *units)
    p = scale(problem)
    matrix, q = dense(problem)
    impulses = np.random.default_rng(5).normal(size=(9, 3)) * np.linalg.norm(q) / matrix[0, 0]
    x = from_impulses(p, impulses)
    np.testing.assert_allclose(to_impulses(p, x), impulses, rtol=1e-14)
    v = velocities(p, x)
    expected = (matrix @ impulses.ravel() + q).reshape(-1, 3)
    np.testing.assert_allclose(
        v * p.length / p.s[:, None], expected, atol=1e-13 * np.abs(expected).max()
    )
    assert scaled_residual(p, x, v) == pytest.approx(residual(problem, impulses).scaled, rel=1e-12)


@pytest.mark.parametrize("floors", [3, 40], ids=["full", "sparse"])
def test_a_factor_solves_the_rows_that_are_kept(floors: int) -> None:
    p = scale(stack(6, floors))
    rng = np.random.default_rng(7)
    keep = rng.uniform(size=p.b.shape) < 0.7
    diagonal = rng.uniform(0.5, 1.0, p.b.shape)
    right = rng.normal(size=p.b.shape)
    z = factorise(p, p.blocks, keep, diagonal).solve(right)
    assert not z[~keep].any()
    missed = (p.matrix @ z.ravel()).reshape(-1, 3) + diagonal * z - right
    # A has rows of some ten entries of about 1, and with the diagonal a condition below 1e3.
    assert np.abs(missed[keep]).max() < 1e-11


def test_steps_converge_faster_than_any_ratio() -> None:
    """Once every contact has its state; eps falls tenfold a step and is all that is left."""
    problem = heap(3, 6, corners=1)
    p = scale(problem)
    near = solve(problem, "projected_gauss_seidel", 1e-4).impulses
    budget = Budget(1e-13, 100)
    x, reached = newton_steps(p, from_impulses(p, near), budget)
    assert reached <= 1e-13
    history = np.array(budget.history)
    assert len(history) <= 8
    assert history[-1] < 1e-2 * history[-2] < 1e-3 * history[-3]
    assert np.linalg.norm(iterate_at(p, x).F) < 1e-12


def test_steps_never_leave_the_natural_map_larger() -> None:
    for name in ("light below heavy", "a heap", "everything slides", "wedged"):
        p = scale(HARD[name]())
        x, sizes = np.zeros_like(p.b), [iterate_at(p, np.zeros_like(p.b)).size]
        for _ in range(10):
            x, _ = newton_steps(p, x, Budget(1e-12, 1), eps=1e-4)
            sizes.append(iterate_at(p, x).size)
        assert np.all(np.diff(sizes) <= 0.0), name


def test_steps_stop_when_everything_is_spent() -> None:
    p = scale(heap(0, 10, mu=2.0))
    budget = Budget(1e-14, 4)
    newton_steps(p, np.zeros_like(p.b), budget)
    assert budget.steps == len(budget.history) <= 4
