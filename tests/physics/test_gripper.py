"""A gripper: a jaw on a fixed joint and one on a slider hold a box by friction, or let it slip."""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config

FRICTION, MASS, JAW = 0.5, 1.0, 0.2  # [-], of the box and of each jaw [kg]
HOLDS, SLIPS, DURATION = 12.0, 8.0, 0.2  # pushes of the jaw [N], [s]
JAW_SHAPE = "{kind: box, size: [0.02, 0.1, 0.1]}"
TEXT = f"""
scene:
  surfaces: {{one: {{friction: {FRICTION}, restitution: 0}}}}
  bodies:
    arm: {{shape: {{kind: sphere, radius: 0.01}}, fixed: true, position: [0, 0, 1]}}
    still: {{shape: {JAW_SHAPE}, mass: {JAW}, position: [-0.06, 0, 0], surface: one}}
    moving: {{shape: {JAW_SHAPE}, mass: {JAW}, position: [0.06, 0, 0], surface: one}}
    load:
      shape: {{kind: box, size: [0.1, 0.1, 0.1]}}
      mass: {MASS}
      position: [0, 0, 0]
      surface: one
  connections:
    bracket: {{kind: fixed, between: [arm, still], at: [-0.06, 0, 0]}}
    guide: {{kind: slider, between: [arm, moving], at: [0.06, 0, 0], axis: [1, 0, 0]}}
  forces: [{{body: moving, force: [-PUSH, 0, 0]}}]
numerics: {{timestep: 1/240}}
duration: {DURATION}
"""


def gripped(push: float) -> Course:
    return run_config(TEXT.replace("PUSH", repr(push)))[0]


def forces(course: Course, joint: int) -> np.ndarray:
    """Return a joint's force in the last step [N]."""
    rows = course.contact[course.contact["step"] == course.contact["step"].max()]
    own = rows[rows["joint"] == joint]
    return own["force_n"] @ np.column_stack([own[f"n{axis}"] for axis in "xyz"])


def test_friction_of_both_jaws_holds_the_box_and_joints_carry_all_of_it() -> None:
    """2 mu N = 12 N, of which it takes 9.81 N."""
    course = gripped(HOLDS)
    pose = course.pose[:, course.names.index("load"), :3]
    # Solves leave 1e-9 m/s a step, for 0.2 s.
    np.testing.assert_allclose(pose, 0.0, atol=1e-9 * DURATION)
    fixed, sliding = forces(course, 1), forces(course, 2)
    weight = (MASS + 2.0 * JAW) * GRAVITY
    # 1e-9 m/s of a step of 1/240 s.
    assert abs(fixed[2] + sliding[2]) == pytest.approx(weight, rel=1e-6)
    assert abs(fixed[0]) == pytest.approx(HOLDS, rel=1e-6)
    assert sliding[0] == pytest.approx(0.0, abs=1e-6)


def test_a_box_that_is_pushed_too_little_slips_by_what_friction_leaves() -> None:
    """(g - 2 mu N/m) t^2/2; its jaws, pressed past their middle, do not tilt."""
    course = gripped(SLIPS)
    left = GRAVITY - 2.0 * FRICTION * SLIPS / MASS
    # A step too much or too little of it: impacts and the first step are of first order.
    fallen, late = 0.5 * left * DURATION**2, left * DURATION / 240.0
    assert -course.height("load")[-1] == pytest.approx(fallen, abs=2.0 * late)
    for jaw in ("still", "moving"):
        turn = course.pose[:, course.names.index(jaw), 3:7]
        np.testing.assert_allclose(turn, [[1, 0, 0, 0]] * len(turn), atol=1e-7)
