"""The fits of a step: what is left over is split among the laws, and nothing of it is lost."""

from __future__ import annotations

import numpy as np
import pytest
from made_motion import DT, MASS, RADIUS, G, ball, given, motion, states

from lavendersim.laws.contacts import ContactSearch
from lavendersim.laws.fits import fits_of, impulses_of
from lavendersim.laws.momentum import BodyStates, StepMomentum, momentum_of
from lavendersim.laws.points import PointsOfPose, points_at, together

BEFORE = np.array([1.0, 0.0, -0.2, 0.0, 0.0, 0.0])


def step(impulse: list[float], more: list[float]) -> tuple[StepMomentum, list[PointsOfPose]]:
    """Return a step with an impulse at the floor [N s] and a change of velocity without one."""
    after = BEFORE + given(impulse) + np.array(more)
    after[2] -= G * DT
    place = [0.0, 0.0, RADIUS]
    made = motion(ball(), *states((place, BEFORE.tolist()), (place, after.tolist())))
    search = ContactSearch(made)
    ends = (BodyStates(made.pose[0], made.velocity[0]), BodyStates(made.pose[1], made.velocity[1]))
    momentum = momentum_of(search, *ends, DT)
    return momentum, together([points_at(search, s, ends, momentum, DT) for s in (0.0, 0.5, 1.0)])


def test_impulses_of_all_poses_together_are_the_impulse() -> None:
    impulse = [-0.1, 0.05, 0.6]
    momentum, looks = step(impulse, [0.0] * 6)
    fits = fits_of(momentum, looks)
    frames = np.concatenate([one.contacts.frame for one in looks])
    total = np.einsum("nij,ni->j", frames, fits.impulses)
    assert total == pytest.approx(impulse, abs=1e-13)
    assert not any(one.any() for law, one in fits.missing.items() if law != "momentum")


def test_what_the_laws_miss_adds_up_to_what_the_first_fit_leaves() -> None:
    """A pull of which a part is a spin about the normal, which no impulse of a contact gives."""
    momentum, looks = step([0.4, 0.0, -0.3], [0.0, 0.0, 0.0, 0.0, 0.0, 2.0])
    fits = fits_of(momentum, looks)
    rows = np.concatenate([one.rows[:, 1] for one in looks])
    explained = np.einsum("nij,ni->j", rows, fits.impulses)
    left = momentum.unexplained - explained
    assert sum(fits.missing.values())[0] == pytest.approx(left, abs=1e-13)
    spin = momentum.scaled(np.array([[0, 0, 0, 0, 0, 0.4 * MASS * RADIUS**2 * 2.0]]))
    assert fits.missing["momentum"] == pytest.approx(spin, abs=1e-13)
    assert np.linalg.norm(fits.missing["adhesion"]) > 0.1


def test_a_cost_takes_no_momentum() -> None:
    momentum, looks = step([-0.1, 0.05, 0.6], [0.0] * 6)
    cost = np.zeros((3, 3))
    cost[0, 0] = 1.0  # the pose of the start
    impulses = impulses_of(momentum, looks, cost)
    rows = np.concatenate([one.rows[:, 1] for one in looks])
    assert np.einsum("nij,ni->j", rows, impulses) == pytest.approx(momentum.unexplained, abs=1e-13)
    assert impulses[0, 0] < 1e-6
