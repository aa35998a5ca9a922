"""A spring that stands for a coefficient of restitution keeps it over its free half swing."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from lavendersim.peers.restitution_spring import SWING_STEPS, restitutions, spring_of

DT = 1.0 / 240.0


@pytest.mark.parametrize("e", [0.05, 0.5, 0.8, 1.0])
def test_a_half_swing_takes_its_steps_and_leaves_e_of_the_speed(e: float) -> None:
    """The exact flow of x'' = -w^2 x - 2 zeta w x' over the swing, by the matrix exponential."""
    stiffness, damping = spring_of(e, DT)
    flow = expm(np.array([[0.0, 1.0], [stiffness, damping]]) * SWING_STEPS * DT)
    place, speed = flow @ (0.0, -1.0)
    assert speed == pytest.approx(e, rel=1e-9)
    assert abs(place) < 1e-9 * SWING_STEPS * DT


def test_what_is_read_back_is_what_was_given_and_a_time_constant_is_no_rebound() -> None:
    asked = [0.05, 0.5, 0.8, 1.0]
    rows = np.array([*(spring_of(e, DT) for e in asked), (0.02, 1.0)])
    np.testing.assert_allclose(restitutions(rows), [*asked, 0.0], rtol=1e-13)
