"""Fast bodies meet what is on their way, wherever in a step they do, and nothing beside it.

At 60 Hz a body of 100 m/s moves 1.67 m a step. No gravity, no friction, no bounce: what is not hit
keeps its velocity to the last bit, what hits a wall stays on its side of it.
"""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import Course, run_config

PHASES = (0.0, 0.3, 0.6, 0.9)  # of a step's way, added to where the bodies start
DT = 1.0 / 60.0
WALL = "{kind: box, size: [0.02, 4, 4]}"
BALL, BRICK = "{kind: sphere, radius: 0.05}", "{kind: box, size: [0.2, 0.2, 0.2]}"


def scene(phase: float) -> str:
    """Return a config of pairs 50 m apart along y."""
    ball, shot, plate = (v * DT * (1.0 + phase) for v in (100.0, 1000.0, 20.0))
    fast = "velocity: [100, 0, 0]"
    return f"""\
scene:
  gravity: [0, 0, 0]
  bodies:
    wall: {{shape: {WALL}, fixed: true, position: [0, 0, 0]}}
    over: {{shape: {BALL}, mass: 1, position: [{-ball}, 0, 2.06], {fast}}}
    hits: {{shape: {BALL}, mass: 1, position: [{-ball}, 0, -1.5], {fast}}}
    other_wall: {{shape: {WALL}, fixed: true, position: [0, 50, 0]}}
    brick: {{shape: {BRICK}, mass: 1, position: [{-ball}, 50, 2.11], {fast}}}
    thud: {{shape: {BRICK}, mass: 1, position: [{-ball}, 50, -1.5], {fast}}}
    first: {{shape: {BALL}, mass: 1, position: [{-ball}, 100, 0], {fast}}}
    second: {{shape: {BALL}, mass: 1, position: [0, 100.11, {-ball}], velocity: [0, 0, 100]}}
    meets: {{shape: {BALL}, mass: 1, position: [{-ball}, 150, 0], {fast}}}
    met: {{shape: {BALL}, mass: 3, position: [0, 150, {-ball}], velocity: [0, 0, 100]}}
    foil: {{shape: {{kind: box, size: [0.001, 1, 1]}}, fixed: true, position: [0, 200, 0]}}
    shot:
      shape: {{kind: sphere, radius: 0.001}}
      mass: 0.01
      position: [{-shot}, 200, 0]
      velocity: [1000, 0, 0]
    door: {{shape: {WALL}, fixed: true, position: [0, 250, 0]}}
    plate:
      shape: {{kind: box, size: [1, 0.01, 1]}}
      mass: 1
      position: [{-0.5 - plate}, 250, 0]
      velocity: [20, 0, 0]
      angular_velocity: [0, 0, 30]
numerics: {{timestep: 1/60}}
duration: 0.1
"""


@pytest.fixture(scope="module", params=PHASES)
def course(request) -> Course:
    return run_config(scene(request.param))[0]


def velocities(course: Course, body: str) -> np.ndarray:
    return np.diff(course.pose[:, course.names.index(body), :3], axis=0) / DT


@pytest.mark.parametrize("body", ["over", "brick", "first"])
def test_what_passes_by_one_centimetre_is_not_stopped(course: Course, body: str) -> None:
    """Made from the start of the step, the contact's plane lies across the way."""
    # positions of up to 10 m are right to 2e-15 m, which is 1e-13 m/s
    np.testing.assert_allclose(velocities(course, body), [[100, 0, 0]] * 6, atol=1e-12)


@pytest.mark.parametrize(("body", "radius"), [("hits", 0.05), ("thud", 0.1)])
def test_what_meets_the_wall_stops_at_it(course: Course, body: str, radius: float) -> None:
    x = course.pose[:, course.names.index(body), 0]
    # of 100 N s the solver leaves a residual of 1e-7 m/s, the default tolerance, for 0.1 s
    assert x[-1] == pytest.approx(-0.01 - radius, abs=1e-8 + 1e-7)


def test_a_shot_of_1_mm_at_1000_m_per_s_stops_at_a_foil_of_1_mm(course: Course) -> None:
    x = course.pose[:, course.names.index("shot"), 0]
    assert x[-1] == pytest.approx(-0.0005 - 0.001, abs=1e-8 + 1e-7)


def test_two_that_meet_share_their_momentum_along_the_line_of_their_centres(
    course: Course,
) -> None:
    """Both are as far from the crossing: n = (1, 0, -1)/sqrt(2) from the first to the second."""
    n = np.array([1.0, 0.0, -1.0]) / np.sqrt(2.0)
    v, w = np.array([100.0, 0, 0]), np.array([0, 0, 100.0])
    impulse = (v - w) @ n / (1.0 / 1.0 + 1.0 / 3.0) * n
    np.testing.assert_allclose(velocities(course, "meets")[-1], v - impulse / 1.0, atol=1e-6)
    np.testing.assert_allclose(velocities(course, "met")[-1], w + impulse / 3.0, atol=1e-6)


def test_a_spinning_plate_does_not_pass_the_wall(course: Course) -> None:
    """It turns by half a radian a step; no corner of it comes out behind the wall."""
    place = course.pose[:, course.names.index("plate")]
    for x, _, _, w, i, j, k in place:
        assert (i, j) == pytest.approx((0.0, 0.0), abs=1e-9)
        angle = 2.0 * np.arctan2(k, w)
        reach = 0.5 * abs(np.cos(angle)) + 0.005 * abs(np.sin(angle))
        assert x + reach <= 0.01
