"""Where bodies first meet within a step, by hand."""

from __future__ import annotations

import numpy as np
import pytest
from made_motion import DT, RADIUS, G, ball, motion, states

from lavendersim.geometry.rotations import rotation_matrices
from lavendersim.laws.contacts import ContactSearch
from lavendersim.laws.meeting import meeting_pose, turned
from lavendersim.laws.momentum import BodyStates, momentum_of
from lavendersim.laws.points import points_at


def met(height: float, speed: float) -> np.ndarray | None:
    """Return where a ball meets the floor that is so high above it and falls with a speed."""
    place = [0.0, 0.0, RADIUS + height]
    before = [0.5, 0.0, -speed, 0.0, 3.0, 0.0]
    made = motion(ball(), *states((place, before), (place, [*before[:2], speed, 0, 3, 0])))
    search = ContactSearch(made)
    ends = (BodyStates(made.pose[0], made.velocity[0]), BodyStates(made.pose[1], made.velocity[1]))
    momentum = momentum_of(search, *ends, DT)
    points = points_at(search, 0.0, ends, momentum, DT)
    return meeting_pose(points, ends[0], momentum, DT)


def test_a_ball_meets_the_floor_at_its_radius() -> None:
    """8 mm at 2 m/s: 3.95 ms. The mean velocity is that of the whole step, so 10 m/s^2 count for
    dt/2 of it and not for half of 3.95 ms: the height is off by 3e-3 s * 0.02 m/s at the most."""
    pose = met(0.008, 2.0)
    assert pose is not None
    time = 0.008 / (2.0 + 0.5 * G * DT)
    assert pose[1, 2] == pytest.approx(RADIUS, abs=0.5 * G * DT * time)
    assert pose[1, 0] == pytest.approx(0.5 * time, rel=1e-12)
    assert pose[1, 3] == pytest.approx(np.cos(1.5 * time), rel=1e-12)


def test_what_meets_nothing_has_no_such_pose() -> None:
    assert met(0.03, 2.0) is None  # 20.5 mm in the step
    assert met(0.0, 0.0) is None  # rests: no gap


def test_turns_are_those_of_the_world() -> None:
    random = np.random.default_rng(2)
    q = random.normal(size=(4, 4))
    q /= np.linalg.norm(q, axis=1)[:, None]
    quarter = np.tile([0.0, 0.0, np.pi / 2], (4, 1))
    about_z = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for after, before in zip(
        rotation_matrices(turned(q, quarter)), rotation_matrices(q), strict=True
    ):
        assert after == pytest.approx(about_z @ before, abs=1e-15 * 10)
    assert turned(q, np.zeros((4, 3))) == pytest.approx(q, abs=1e-16)
