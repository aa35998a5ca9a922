"""What flies, and reaches nothing, has nothing for the projection to repair.

A fall that ends just above the floor; a ball hit late in a step, whose new velocity would
take it into a wall in a whole step, and does not in the rest of this one.
"""

from __future__ import annotations

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
numerics: {{timestep: 1/60}}
duration: 0.1
sweep:
  height:
    path: scene.bodies.ball.position.2
    values: [{", ".join(repr(round(0.1 + FALL + gap, 9)) for gap in GAPS)}]
"""


def test_a_ball_just_above_the_floor_is_where_it_fell_to() -> None:
    for course in run_config(TEXT):
        time = np.arange(len(course.step)) * course.dt
        heights = course.coordinates["height"] - 0.5 * GRAVITY * time**2
        # ten roundings of 2^-53 of a height of up to 0.2 m
        assert np.abs(course.height("ball") - heights).max() < 1e-15 * len(time)


WAY = 1.0 / 60.0  # of a ball of 1 m/s in a step [m]
AHEAD = 0.35 * WAY
HIT = """\
scene:
  gravity: 0
  surfaces: {elastic: {restitution: 1}}
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
WALL = f"""\
    wall:
      shape: {{kind: plane, normal: [-1, 0, 0], offset: {-(AHEAD + 0.1)!r}}}
      surface: elastic
"""
BOULDER = f"""\
    boulder:
      shape: {{kind: sphere, radius: 10}}
      fixed: true
      surface: elastic
      position: [{AHEAD + 0.1 + 10.0!r}, 0, 0]
"""


@pytest.mark.parametrize("share", [0.7, 0.9, 0.99])
@pytest.mark.parametrize("ahead", [(WALL, ""), ("", BOULDER)], ids=["body B", "body A"])
def test_a_ball_hit_late_in_a_step_is_not_pushed_off_what_is_ahead(
    share: float, ahead: tuple[str, str]
) -> None:
    """It is hit after `share` of the step, and takes over the speed of its equal along x.

    Both move along what is ahead, so that it is looked at from the step's start: a wall, of whose
    contact the ball is body B, or a boulder, whose contact with the ball has it for body A.
    """
    first, last = ahead
    (course,) = run_config(HIT % (first, -(0.2 + share * WAY), last))
    if last:
        assert course.names.index("hit") < course.names.index("boulder")
    hit, striker = (course.pose[-1, course.names.index(one), 0] for one in ("hit", "striker"))
    # steps are solved to 1e-9 m/s, over a step
    assert hit == pytest.approx((1.0 - share) * WAY, abs=1e-9 * WAY)
    assert striker == pytest.approx(-0.2, abs=1e-9 * WAY)
