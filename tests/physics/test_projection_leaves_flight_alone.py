"""What flies, and reaches nothing, has nothing for the projection to repair.

A fall that ends just above the floor; a ball hit late in a step, whose new velocity would
take it into a wall in a whole step, and does not in the rest of this one; one that a force drives
to and from the wall, before it is hit and after.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from physics_runs import GRAVITY, run_config

# Gaps left after 6 steps of 1/60 s, about g dt^2/2 = 1.4 mm: with the new velocity alone the ball
# would reach the floor where they are less; with the mean of old and new it never does.
GAPS = (1e-4, 4e-4, 1e-3, 1.3e-3, 2e-3)  # [m]
FALL = 0.5 * GRAVITY * 0.1**2
TEXT = f"""\
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1.0, position: [0, 0, 1]}}
numerics: {{timestep: 1/60, impacts: at_surface}}  # of one pair alone no other law than in order
duration: 0.1
sweep:
  height:
    path: scene.bodies.ball.position.2
    values: [{", ".join(repr(round(0.1 + FALL + gap, 9)) for gap in GAPS)}]
"""


def test_a_ball_just_above_the_floor_is_where_it_fell_to() -> None:
    for course in run_config(TEXT, interpreted=True):
        time = np.arange(len(course.step)) * course.dt
        heights = course.coordinates["height"] - 0.5 * GRAVITY * time**2
        # ten roundings of 2^-53 of a height of up to 0.2 m
        assert np.abs(course.height("ball") - heights).max() < 1e-15 * len(time)


WAY = 1.0 / 60.0  # of a ball of 1 m/s in a step [m]
AHEAD = 0.35 * WAY
HIT = """\
scene:
  gravity: [%r, 0, 0]
  surfaces: {elastic: {restitution: %r}}
  bodies:
%s    hit:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: elastic
      position: [0, 0, 0]
      velocity: [0, 1, 0]
    striker:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: elastic
      position: [%r, 0, 0]
      velocity: [1, 1, 0]
%snumerics: {timestep: 1/60, impacts: at_surface}
duration: 1/60
"""


def wall(ahead: float) -> str:
    """Return a wall `ahead` of the ball that is hit [m]: of their contact the ball is body B."""
    return f"""\
    wall:
      shape: {{kind: plane, normal: [-1, 0, 0], offset: {-(ahead + 0.1)!r}}}
      surface: elastic
"""


def boulder(ahead: float) -> str:
    """Return a boulder `ahead` of the ball that is hit [m]: of their contact the ball is body A."""
    return f"""\
    boulder:
      shape: {{kind: sphere, radius: 10}}
      fixed: true
      surface: elastic
      position: [{ahead + 0.1 + 10.0!r}, 0, 0]
"""


def places(share: float, ahead: str, force: float = 0.0, e: float = 1.0) -> tuple[float, float]:
    """Return where the ball that is hit and its striker are along x after the step [m].

    share: of the step, after which it is hit; force: on both, per mass [m/s^2].
    """
    first, last = (ahead, "") if "plane" in ahead else ("", ahead)
    (course,) = run_config(HIT % (force, e, first, -(0.2 + share * WAY), last), interpreted=True)
    if last:
        assert course.names.index("hit") < course.names.index("boulder")
    hit, striker = (course.pose[-1, course.names.index(one), 0] for one in ("hit", "striker"))
    return hit, striker


@pytest.mark.parametrize("share", [0.7, 0.9, 0.99])
@pytest.mark.parametrize("ahead", [wall, boulder], ids=["body B", "body A"])
def test_a_ball_hit_late_in_a_step_is_not_pushed_off_what_is_ahead(
    share: float, ahead: Callable[[float], str]
) -> None:
    """It is hit after `share` of the step, and takes over the speed of its equal along x.

    Both move along what is ahead, so that it is looked at from the step's start: a wall, of whose
    contact the ball is body B, or a boulder, whose contact with the ball has it for body A.
    """
    hit, striker = places(share, ahead(AHEAD))
    # steps are solved to 1e-9 m/s, over a step
    assert hit == pytest.approx((1.0 - share) * WAY, abs=1e-9 * WAY)
    assert striker == pytest.approx(-0.2, abs=1e-9 * WAY)


FORCE = 5.4  # [m/s^2]
BESIDE = 1e-6  # of what is ahead, which the ball just does not reach [m]


@pytest.mark.parametrize("share", [0.1, 0.3, 0.7, 0.9])
@pytest.mark.parametrize("force", [FORCE, -FORCE])
@pytest.mark.parametrize("ahead", [wall, boulder], ids=["body B", "body A"])
def test_what_forces_do_before_and_after_a_hit_is_way_and_no_overlap(
    share: float, force: float, ahead: Callable[[float], str]
) -> None:
    """The ball flies (1 - share) WAY by its new speed, and force dt^2/2 by the force, as if alone.

    By force rest^2/2 its speed at the end is no measure of its way after the hit.
    """
    way = (1.0 - share) * WAY + 0.5 * force / 60.0**2
    hit, striker = places(share, ahead(max(way, 0.0) + BESIDE), force)
    assert hit == pytest.approx(way, abs=1e-9 * WAY)
    assert striker == pytest.approx(-0.2 + 0.5 * force / 60.0**2, abs=1e-9 * WAY)


@pytest.mark.parametrize("share", [0.3, 0.7, 0.9])
@pytest.mark.parametrize("force", [FORCE, -FORCE])
@pytest.mark.parametrize("ahead", [wall, boulder], ids=["body B", "body A"])
def test_what_forces_do_before_a_plastic_hit_is_way_and_no_overlap(
    share: float, force: float, ahead: Callable[[float], str]
) -> None:
    """Balls that stay together move by their common speed at the end, (1 m/s)/2 + force dt."""
    tau, rest = share / 60.0, (1.0 - share) / 60.0
    way = 0.5 * force * tau**2 + rest * (0.5 + force / 60.0)
    hit, _ = places(share, ahead(max(way, 0.0) + BESIDE), force, e=0.0)
    assert hit == pytest.approx(way, abs=1e-9 * WAY)


@pytest.mark.parametrize("reached", [0.2, 0.6, 0.95])
@pytest.mark.parametrize("ahead", [wall, boulder], ids=["body B", "body A"])
def test_a_ball_that_would_reach_what_is_ahead_ends_the_step_at_it(
    reached: float, ahead: Callable[[float], str]
) -> None:
    way = 0.7 * WAY + 0.5 * FORCE / 60.0**2
    hit, _ = places(0.3, ahead(reached * way), FORCE)
    # within the slop of 1e-7 m, which bodies overlap by when they rest
    assert hit == pytest.approx(reached * way, abs=1.01e-7)
