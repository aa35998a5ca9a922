"""What bounces on a belt: only the slip of the surfaces counts, not how fast the belt runs.

A ball leaves with e times its approach speed whatever the belt does, since no tangential impulse at
its surface changes the normal velocity of its contact. A rod that comes down on one end couples the
two; for it the law is Galilei's: with belt and rod faster by the same velocity along the belt, the
motion is the same but for that velocity. Both without gravity, so that flight is even.
"""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import Course, run_config

E, MU, MASS = 0.95, 0.5, 1.0
APPROACH = 2.0  # [m/s]
BELTS = (-1.0, 0.5, 3.0, -30.0)  # speeds of the belt past the body that comes down [m/s]
FRAMES = (2.0, 5.0, -20.0)  # of both [m/s]
SCENE = """\
scene:
  gravity: 0
  surfaces: {{rubber: {{friction: {mu}, restitution: {e}}}}}
  bodies:
    belt: {{shape: {{kind: plane}}, surface: rubber, surface_velocity: [{belt}, 0, 0]}}
    {body}
numerics: {{timestep: 1/240}}
duration: 0.06
"""
BALL = """\
ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, surface: rubber, position: [0, 0, 0.15],
           velocity: [{along}, 0, {down}]}}"""
ROD = """\
rod: {{shape: {{kind: capsule, radius: 0.02, length: 0.5}}, mass: 1, surface: rubber,
          orientation: {{axis: [0, 1, 0], degrees: {tilt}}},
          release: {{above: belt, clearance: 0.05}}, velocity: [{along}, 0, {down}]}}"""
# Positions are sums of some ten numbers below 1.3 m, each rounded; a contact is solved to 1e-9 m/s,
# and flies on for 0.06 s at the most, in which a rod's end of 0.25 m turns what the impulse misses.
LEFT = 1e-9


def bounced(body: str, belt: float, **values: float) -> Course:
    values = {"along": 0.0, "down": -APPROACH, **values}
    text = SCENE.format(mu=MU, e=E, belt=belt, body=body.format(**values))
    return run_config(text, interpreted=body == BALL)[0]


@pytest.mark.parametrize("belt", BELTS)
def test_a_ball_leaves_a_belt_with_e_times_its_approach_speed(belt: float) -> None:
    course = bounced(BALL, belt)
    leaves = np.diff(course.height("ball"))[-1] / course.dt
    assert leaves == pytest.approx(E * APPROACH, abs=LEFT)
    assert not course.step["stronge"].any()  # Newton's law gives no energy here


@pytest.mark.parametrize("belt", BELTS)
def test_a_ball_is_taken_along_by_coulombs_impulse_at_most(belt: float) -> None:
    """Impulse mu (1 + e) m v_n, or what stops the slip: 2/7 m of it, for a solid ball."""
    course = bounced(BALL, belt)
    along = np.diff(course.pose[:, course.names.index("ball"), 0])[-1] / course.dt
    most = min(MU * (1.0 + E) * APPROACH, abs(belt) * 2.0 / 7.0)
    assert along == pytest.approx(np.copysign(most, belt), abs=LEFT)


def rod_on(belt: float, tilt: float, frame: float) -> Course:
    return bounced(ROD, belt + frame, along=frame, tilt=tilt)


@pytest.mark.parametrize("tilt", [30.0, 60.0])
@pytest.mark.parametrize("belt", BELTS)
def test_a_rod_bounces_alike_on_belts_and_in_frames_that_move_alike(
    belt: float, tilt: float
) -> None:
    seen = []
    for frame in FRAMES:
        course = rod_on(belt, tilt, frame)
        pose = course.pose[:, course.names.index("rod")].copy()
        pose[:, 0] -= frame * course.dt * np.arange(len(pose))
        seen.append(pose)
    for pose in seen[1:]:
        np.testing.assert_allclose(pose, seen[0], atol=LEFT)


@pytest.mark.parametrize("frame", FRAMES)
def test_an_impact_on_a_belt_that_newton_gives_energy_is_left_to_stronge(frame: float) -> None:
    """Relative to the belt energy falls: K - m s v_x + m s^2 / 2, s the belt's speed."""
    belt = -1.0
    step = rod_on(belt, 30.0, frame).step
    assert step["stronge"].sum() == 1
    s = belt + frame
    relative = step["kinetic_energy"] - s * step["momentum_x"] + 0.5 * MASS * s * s
    # The impulse, below 4 N s, is solved to 1e-9 m/s.
    assert np.diff(relative).max() < 4.0 * 1e-9
    assert relative[-1] < 0.99 * relative[0]
