"""The turning that a contact sees as a round of Newton's method begins, and what a step adds."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted
from plain_facts import one_row, vector_fields

from lavendersim.engine.solvers.newton.envelope import DOF, WX
from lavendersim.engine.solvers.newton.torques import make_directional_spin, make_start_torques
from lavendersim.engine.spec import Spec

SPEC = Spec(("friction", "rolling_friction", "rotation", "torsional_friction"))


@pytest.mark.parametrize(("a", "b"), [(0, 1), (1, 0), (-1, 1), (1, -1)])
def test_it_is_the_spin_of_b_less_that_of_a_in_the_contacts_frame(a: int, b: int, rng) -> None:
    """A body that nothing moves has the number -1."""
    frame, step = random_frame(rng), rng.normal(size=2 * DOF)
    contact = one_row(
        step_spin_n=0.0,
        step_spin_1=0.0,
        step_spin_2=0.0,
        **vector_fields("n", frame[0]),
        **vector_fields("t1", frame[1]),
        **vector_fields("t2", frame[2]),
    )
    interpreted(make_directional_spin(SPEC))(contact, a, b, step)
    spin = {k: step[DOF * k + WX : DOF * (k + 1)] if k >= 0 else np.zeros(3) for k in (a, b)}
    found = [contact.step_spin_n, contact.step_spin_1, contact.step_spin_2]
    np.testing.assert_allclose(found, frame @ (spin[b] - spin[a]), atol=1e-15)


def test_a_round_begins_with_the_spin_of_both_bodies_in_the_contacts_frame(rng) -> None:
    """And with torques that give way by a softness, up to a lever times the normal impulse."""
    frame, spins, psi = random_frame(rng), rng.normal(size=(2, 3)), rng.normal(size=3)
    names = ("start_psi", "spin", "step_spin", "psi")
    contact = one_row(
        **{f"{name}_{k}": 7.0 for name in names for k in "n12"},
        **{f"{name}_{kind}": 7.0 for name in ("stiff", "limit") for kind in ("torsion", "roll")},
        **{"k_torsion": 0.8, "k_roll": 1.6, "torsional": 0.03, "rolling": 0.02, "lambda_n": 5.0},
        **vector_fields("n", frame[0]),
        **vector_fields("t1", frame[1]),
        **vector_fields("t2", frame[2]),
    )
    contact.psi_n, contact.psi_1, contact.psi_2 = psi
    rows = (one_row(**vector_fields("w", spin)) for spin in spins)
    interpreted(make_start_torques(SPEC))(contact, *rows, 0.5)
    found = {name: np.array([contact[f"{name}_{k}"] for k in "n12"]) for name in names}
    np.testing.assert_allclose(found["spin"], frame @ (spins[1] - spins[0]), atol=1e-15)
    np.testing.assert_array_equal(found["start_psi"], psi)
    assert not found["step_spin"].any()
    assert (contact.stiff_torsion, contact.stiff_roll) == pytest.approx((2.5, 1.25), rel=1e-15)
    assert (contact.limit_torsion, contact.limit_roll) == pytest.approx((0.15, 0.1), rel=1e-15)
