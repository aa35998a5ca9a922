"""What a step of Newton's method adds to the turning that a contact sees."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted
from plain_facts import one_row, vector_fields

from lavendersim.engine.solvers.newton.envelope import DOF, WX
from lavendersim.engine.solvers.newton.torques import make_directional_spin
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
