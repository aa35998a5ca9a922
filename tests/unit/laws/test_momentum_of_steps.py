"""Momenta of a step: what forces explain, what is left, and the coordinates of kinetic energy."""

from __future__ import annotations

import numpy as np
import pytest
from made_motion import DT, INERTIA, MASS, G, ball, motion, states

from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.laws.contacts import ContactSearch
from lavendersim.laws.momentum import BodyStates, half_way, inertias, momentum_of

RANDOM = np.random.default_rng(3)


def test_gravity_and_forces_are_explained() -> None:
    """A force of 4 N and a torque about z, in the air: nothing is left."""
    forces = "  forces:\n    - {body: ball, force: [4, 0, 0], torque: [0, 0, 0.5], to: 1}\n"
    text = ball().replace("numerics:", f"{forces}numerics:")
    after = [4 * DT / MASS, 0, -G * DT, 0, 0, 0.5 * DT / INERTIA]
    made = motion(text, *states(([0, 0, 2], [0] * 6), ([0, 0, 2], after)))
    search = ContactSearch(made)
    search.begin(0)
    ends = [BodyStates(made.pose[k], made.velocity[k]) for k in (0, 1)]
    found = momentum_of(search, *ends, DT)
    assert found.movable.tolist() == [1]
    assert np.abs(found.unexplained).max() < 1e-16 * 10


def test_scaled_squares_are_twice_the_kinetic_energy() -> None:
    velocity = [0.3, -0.2, 0.5, 4.0, 5.0, -6.0]
    made = motion(ball(), *states(([0, 0, 2], velocity), ([0, 0, 2], velocity)))
    search = ContactSearch(made)
    end = BodyStates(made.pose[0], made.velocity[0])
    found = momentum_of(search, end, end, DT)
    energy = 0.5 * MASS * (0.09 + 0.04 + 0.25) + 0.5 * INERTIA * (16 + 25 + 36)
    assert 0.5 * (found.scaled(found.before) ** 2).sum() == pytest.approx(energy, rel=1e-14)


def test_half_way_is_half_the_turn_the_shorter_way() -> None:
    """About z by 1.2 rad: half way it is 0.6, whichever sign the second quaternion has."""
    start = np.array([[1.0, 0.0, 0.0, 0.0]])
    end = np.array([[np.cos(0.6), 0.0, 0.0, np.sin(0.6)]])
    expected = np.array([[np.cos(0.3), 0.0, 0.0, np.sin(0.3)]])
    assert half_way(start, end) == pytest.approx(expected, abs=1e-15)
    assert half_way(start, -end) == pytest.approx(expected, abs=1e-15)


def test_inertias_turn_with_their_bodies() -> None:
    q = RANDOM.normal(size=(5, 4))
    q /= np.linalg.norm(q, axis=1)[:, None]
    moments = np.tile([1.0, 2.0, 3.0], (5, 1))
    found, turn = inertias(moments, q), rotation_matrices(q)
    for k in range(5):
        for axis in range(3):
            along = turn[k][:, axis]
            assert found[k] @ along == pytest.approx(moments[k, axis] * along, abs=1e-14)
