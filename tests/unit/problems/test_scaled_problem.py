"""A scaled problem is the same problem: its velocities and impulses are those of the given one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.problems.matrices import problem_of
from lavendersim.problems.residual import contact_velocities, distances
from lavendersim.problems.scaled_problem import (
    from_impulses,
    multiply,
    scale,
    scaled_residual,
    to_impulses,
    velocities,
)

RANDOM = np.random.default_rng(3)
N = 4


def made(unit: float = 1.0) -> ContactProblem:
    """Return a problem with masses that differ by a million; unit: of its mass."""
    root = np.random.default_rng(4).normal(size=(3 * N, 3 * N))
    heavy = np.repeat([1.0, 1e-3, 1e3, 1.0], 3)
    matrix = heavy[:, None] ** 0.5 * (root @ root.T) * heavy**0.5 / unit
    free = np.random.default_rng(6).normal(size=(N, 3))
    problem = problem_of(sparse.csr_matrix(matrix), free, np.full(N, 0.6))
    return problem._replace(gamma=np.array([0.1, 0.0, 0.0, 0.2]) / unit)


def test_every_contact_has_a_mean_of_one_on_its_diagonal() -> None:
    p = scale(made())
    own = p.blocks[p.rows == p.columns]
    assert np.trace(own, axis1=1, axis2=2) == pytest.approx(np.full(N, 3.0), rel=1e-14)
    assert np.linalg.norm(p.b) == pytest.approx(1.0, rel=1e-15)


def test_velocities_are_those_of_the_given_problem() -> None:
    problem = made()
    p, impulses = scale(problem), RANDOM.normal(size=(N, 3))
    x = from_impulses(p, impulses)
    assert to_impulses(p, x) == pytest.approx(impulses, rel=1e-15)
    assert velocities(p, x) - multiply(p, x) == pytest.approx(p.b, abs=1e-13 * abs(x).max())
    given = contact_velocities(problem, impulses)
    found = p.length * velocities(p, x) / p.s[:, None]
    assert found == pytest.approx(given, rel=1e-12, abs=1e-12 * np.abs(given).max())


def test_residual_is_that_of_the_given_problem() -> None:
    problem = made()
    p, impulses = scale(problem), RANDOM.normal(size=(N, 3))
    x = from_impulses(p, impulses)
    found = scaled_residual(p, x, velocities(p, x))
    assert found == pytest.approx(distances(problem, impulses).scaled, rel=1e-12)


def test_units_of_mass_change_nothing() -> None:
    one, other = scale(made()), scale(made(1000.0))
    assert other.blocks == pytest.approx(one.blocks, rel=1e-13)
    assert other.b == pytest.approx(one.b, rel=1e-13)


def test_what_is_not_finite_is_infinitely_far() -> None:
    p = scale(made())
    x = np.full((N, 3), np.nan)
    assert scaled_residual(p, x, velocities(p, x)) == np.inf
