"""A sweep visits every contact once, in order, at the velocities that the last one left."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted, records
from matrix_solves import matrix_spec
from problems_in_blocks import dense, random_problem

from lavendersim.engine.matrix_problem import contacts_of, coupling_of, system_of
from lavendersim.engine.records import PARAMETERS, dtype
from lavendersim.engine.solvers.sweep import make_sweep


def swept(problem, order, sweeps: int = 1, visits: str = "coloured"):
    """Return (impulses, greatest change of the last sweep, order, velocities)."""
    spec = matrix_spec("projected_gauss_seidel", order=visits)
    count = problem.contacts
    contacts = contacts_of(problem, spec, np.zeros((count, 3)))
    params = np.zeros(1, dtype(PARAMETERS))
    params["over_relaxation"] = 1.0
    system = system_of(contacts, coupling_of(problem))
    system = system._replace(contacts=records(contacts), order=np.array(order))
    sweep, greatest = interpreted(make_sweep(spec)), 0.0
    for _ in range(sweeps):
        greatest = sweep(system, records(params)[0])
    impulses = np.stack([contacts[f"lambda_{k}"] for k in "n12"], axis=1)
    velocities = np.stack([contacts[f"w_{k}"] for k in "n12"], axis=1)
    return impulses, greatest, system.order.tolist(), velocities


def frictionless(problem, order, sweeps: int = 1) -> np.ndarray:
    """Return normal impulses of r_n <- max(0, r_n - w_n/W_nn), written out."""
    matrix = dense(problem)[::3, ::3] + np.diag(problem.gamma)
    r = np.zeros(problem.contacts)
    for _ in range(sweeps):
        for k in order:
            r[k] = max(0.0, r[k] - (matrix[k] @ r + problem.q[k, 0]) / matrix[k, k])
    return r


def test_frictionless_contacts_are_corrected_in_turn(rng) -> None:
    problem = random_problem(rng, 6, coupled=1.0)._replace(mu=np.zeros(6))
    for order in (range(6), (3, 1, 5, 0, 2, 4)):
        for sweeps in (1, 3):
            found, _, kept, velocities = swept(problem, list(order), sweeps)
            np.testing.assert_allclose(
                found[:, 0], frictionless(problem, order, sweeps), atol=1e-13
            )
            assert kept == list(order)
            expected = (dense(problem) @ found.ravel()).reshape(-1, 3) + problem.q
            np.testing.assert_allclose(velocities, expected, atol=1e-12)


def test_symmetric_sweeps_go_there_and_back(rng) -> None:
    problem = random_problem(rng, 5, coupled=1.0)._replace(mu=np.zeros(5))
    order = [2, 0, 4, 1, 3]
    found, _, after, _ = swept(problem, order, 1, "symmetric")
    assert after == order[::-1]
    np.testing.assert_allclose(found[:, 0], frictionless(problem, order), atol=1e-13)
    assert swept(problem, order, 2, "symmetric")[2] == order


def test_the_greatest_change_is_returned_and_a_nan_wins(rng) -> None:
    problem = random_problem(rng, 5, coupled=0.0)._replace(mu=np.zeros(5))
    _, greatest, _, velocities = swept(problem, range(5))
    before = problem.q[:, 0]
    changes = np.abs(velocities[:, 0] - before)
    assert greatest >= changes.max() * (1.0 - 1e-12)  # with gamma a change counts for more
    assert greatest <= 1.5 * changes.max()
    lost = problem._replace(free=problem.free * np.array([[1], [np.nan], [1], [1], [1]]))
    assert np.isnan(swept(lost, range(5))[1])
    assert swept(problem, range(5), 60)[1] < 1e-12
