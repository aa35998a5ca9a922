"""Points that may push, with the velocities of surfaces and what an impulse there gives."""

from __future__ import annotations

import numpy as np
import pytest
from made_motion import DT, INERTIA, MASS, RADIUS, G, ball, motion, states

from lavendersim.laws.contacts import ContactSearch
from lavendersim.laws.momentum import BodyStates, momentum_of
from lavendersim.laws.points import PointsOfPose, points_at, pose_at, together

BEFORE = [1.0, 2.0, -0.5, 3.0, 4.0, 5.0]


def points(height: float = 0.0, share: float = 0.0) -> PointsOfPose:
    place = [0.0, 0.0, RADIUS + height]
    made = motion(ball(), *states((place, BEFORE), (place, [0.0] * 6)))
    ends = (BodyStates(made.pose[0], made.velocity[0]), BodyStates(made.pose[1], made.velocity[1]))
    search = ContactSearch(made)
    return points_at(search, share, ends, momentum_of(search, *ends, DT), DT)


def test_velocities_are_those_of_the_surface() -> None:
    """v + omega x r with r = (0, 0, -R): x 1 - R 4, y 2 + R 3; along n, up, -0.5 and g dt less."""
    found = points()
    (frame,) = found.contacts.frame
    slip = np.array([1.0 - RADIUS * 4.0, 2.0 + RADIUS * 3.0, -0.5])
    assert found.before[0] == pytest.approx(frame @ slip, abs=1e-15)
    assert found.free[0] - found.before[0] == pytest.approx(
        frame @ np.array([0.0, 0.0, -G * DT]), abs=1e-15
    )
    assert not found.after.any()
    assert found.approach[0] == pytest.approx(0.5 + G * DT, rel=1e-14)


def test_rows_give_what_impulses_give() -> None:
    """k_n = 1/m; across it 1/m + R^2/I."""
    (rows,) = points().rows
    block = rows[1] @ rows[1].T
    across = 1 / MASS + RADIUS**2 / INERTIA
    assert block == pytest.approx(np.diag([1 / MASS, across, across]), abs=1e-14)
    assert not rows[0].any()  # the floor
    assert points().softness[0] == pytest.approx(1 / MASS, rel=1e-14)


def test_surfaces_meet_that_can_close_their_gap() -> None:
    """6 mm are the most that 0.5 m/s and g dt close in 10 ms."""
    assert points(height=0.0059).meets.all()
    assert not points(height=0.0061).meets.any()


def test_a_contact_that_meets_in_one_pose_may_push_in_all() -> None:
    near, far = points(height=0.0059), points(height=0.0061)
    assert all(one.meets.all() for one in together([near, far]))
    assert not any(one.meets.any() for one in together([far, far]))


def test_poses_within_a_step() -> None:
    one, other = np.zeros((1, 7)), np.zeros((1, 7))
    one[0, 3] = other[0, 4] = 1.0  # half a turn about x
    other[0, 0] = 2.0
    half = np.sqrt(0.5)
    assert pose_at(0.5, one, other)[0] == pytest.approx([1, 0, 0, half, half, 0, 0])
    assert pose_at(0.0, one, other) is one
    assert pose_at(1.0, one, other) is other
    with pytest.raises(ValueError, match="half way"):
        pose_at(0.3, one, other)
