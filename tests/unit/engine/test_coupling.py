"""An impulse changes velocities by its column of W, whether through blocks or through bodies."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted, records
from problems_in_blocks import dense, random_problem

from lavendersim.engine import coupling
from lavendersim.engine.matrix_problem import contacts_of, coupling_of
from lavendersim.engine.record_layout import allocate_velocities, contact_dtype
from lavendersim.engine.spec import Spec

MATRIX = Spec(solver="jacobi", operator="matrix", effects=("friction",))


def test_blocks_add_the_columns_of_the_dense_matrix(rng) -> None:
    problem = random_problem(rng, 6)
    rows = contacts_of(problem, MATRIX, np.zeros((6, 3)))
    contacts, matrix = records(rows), dense(problem)
    add = interpreted(coupling.make_add_impulse(MATRIX))
    velocity = interpreted(coupling.make_contact_velocity(MATRIX))
    impulses = np.zeros((6, 3))
    for k in (2, 5, 0, 2):
        change = rng.normal(size=3)
        impulses[k] += change
        add(contacts[k], contacts, coupling_of(problem), *change)
    expected = (matrix @ impulses.ravel()).reshape(6, 3) + problem.q
    found = [velocity(contact, None) for contact in contacts]
    np.testing.assert_allclose(found, expected, atol=1e-13)


def test_through_bodies_b_is_pushed_and_a_pulled_along_the_normal() -> None:
    """Without friction and rotation u is v_B - v_A along n, and the target; masses 2 and 0.5 kg."""
    spec = Spec()
    rows, velocities = np.zeros(1, contact_dtype(spec)), allocate_velocities(spec, 2)
    n = np.array([2.0, -1.0, 2.0]) / 3.0
    rows["nx"], rows["ny"], rows["nz"] = n
    rows["a"], rows["b"], rows["inv_m_a"], rows["inv_m_b"], rows["target"] = 0, 1, 0.5, 2.0, 0.1
    contacts, of = records(rows), records(velocities)
    add = interpreted(coupling.make_add_impulse(spec))
    velocity = interpreted(coupling.make_contact_velocity(spec))
    add(contacts[0], contacts, of, 3.0, 0.0, 0.0)
    for row, expected in zip(velocities, (-1.5 * n, 6.0 * n), strict=True):
        np.testing.assert_allclose([row["vx"], row["vy"], row["vz"]], expected, atol=1e-15)
    np.testing.assert_allclose(velocity(contacts[0], of), (7.5 + 0.1, 0.0, 0.0), atol=1e-14)
