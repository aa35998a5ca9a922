"""Records of a problem given by its matrix: products, inverses and bounds of the dense matrix."""

from __future__ import annotations

import numpy as np
import pytest
from problems_in_blocks import dense, random_problem

from lavendersim.engine.matrix_problem import contacts_of, coupling_of, multiply, system_of
from lavendersim.engine.spec import Spec

MATRIX = Spec(solver="jacobi", operator="matrix", effects=("friction",))


def test_products_are_those_of_the_dense_matrix(rng) -> None:
    problem, impulses = random_problem(rng, 7), rng.normal(size=(7, 3))
    expected = (dense(problem) @ impulses.ravel()).reshape(7, 3)
    np.testing.assert_allclose(multiply(problem, impulses), expected, atol=1e-13)


def test_contacts_hold_their_impulse_velocity_and_own_block(rng) -> None:
    problem, impulses = random_problem(rng, 7), rng.normal(size=(7, 3))
    contacts = contacts_of(problem, MATRIX, impulses)
    w = (dense(problem) @ impulses.ravel()).reshape(7, 3) + problem.q
    for k, axis in enumerate("n12"):
        np.testing.assert_array_equal(contacts[f"lambda_{axis}"], impulses[:, k])
        np.testing.assert_allclose(contacts[f"w_{axis}"], w[:, k], atol=1e-13)
    for k, (contact, own) in enumerate(zip(contacts, problem.own_blocks, strict=True)):
        assert contact["k_n"] == own[0, 0]
        assert contact["inv_k"] == pytest.approx(1.0 / (own[0, 0] + problem.gamma[k]), rel=1e-15)
        assert (contact["k_n1"], contact["k_n2"]) == (own[1, 0], own[2, 0])
        inverse = np.array([[contact["i_11"], contact["i_12"]], [contact["i_12"], contact["i_22"]]])
        np.testing.assert_allclose(inverse @ own[1:, 1:], np.eye(2), atol=1e-12)
        assert contact["k_t"] == pytest.approx(np.linalg.eigvalsh(own[1:, 1:])[-1], rel=1e-13)
        assert list(problem.row[contact["begin"] : contact["end"]]) == sorted(
            {i for i, j in zip(problem.row, problem.columns, strict=True) if j == k}
        )


def test_the_bound_is_stiffer_than_the_matrix(rng) -> None:
    """diag(bound) - W - gamma has no negative eigenvalue: no step against it overshoots."""
    for _ in range(5):
        problem = random_problem(rng, 9)
        contacts = contacts_of(problem, MATRIX, np.zeros((9, 3)))
        regularised = dense(problem) + np.diag(np.outer(problem.gamma, [1, 0, 0]).ravel())
        left = np.diag(np.repeat(contacts["bound"], 3)) - regularised
        assert np.linalg.eigvalsh(left)[0] >= -1e-12


def test_scales_are_the_mean_of_the_diagonal_and_the_size_of_the_load(rng) -> None:
    problem = random_problem(rng, 5)
    coupling = coupling_of(problem)
    trace = np.trace(dense(problem)) + problem.gamma.sum()
    assert coupling.mean_diagonal == pytest.approx(trace / 15.0, rel=1e-14)
    assert coupling.load == pytest.approx(np.linalg.norm(problem.q), rel=1e-15)
    unloaded = problem._replace(free=np.zeros((5, 3)), target=np.zeros(5))
    assert coupling_of(unloaded).load == 1.0


def test_a_solver_visits_every_contact_in_order(rng) -> None:
    problem = random_problem(rng, 5)
    contacts = contacts_of(problem, MATRIX, np.zeros((5, 3)))
    system = system_of(contacts, coupling_of(problem))
    assert system.count == 5
    assert system.order.tolist() == list(range(5))
