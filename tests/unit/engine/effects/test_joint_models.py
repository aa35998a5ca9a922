"""Joints as a config says them: limits and motors, and what of them is refused, at its place."""

from __future__ import annotations

import pytest

from lavendersim.engine.effects.joint_models import (
    ABOUT,
    ALONG,
    HingeJoint,
    JointWithAxis,
    SliderJoint,
    holding,
)
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

TEXT = """
scene:
  bodies:
    hook: {{shape: {{kind: sphere, radius: 0.01}}, fixed: true, position: [0, 0, 1]}}
    bob: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 0]}}
  connections:
    arm: {{between: [hook, bob], at: [0, 0, 1], {joint}}}
numerics: {{timestep: 1/100}}
duration: 0.1
"""
HINGE, SLIDER = "kind: hinge, axis: [0, 1, 0]", "kind: slider, axis: [0, 0, 2]"


def joint_of(joint: str) -> JointWithAxis:
    cell = load_experiment_text(TEXT.format(joint=joint), "x.yaml").cells()[0]
    found = holding(cell.config.scene)["arm"]
    assert isinstance(found, JointWithAxis)
    return found


@pytest.mark.parametrize(
    ("joint", "kind", "moves", "motor"),
    [
        (HINGE, HingeJoint, ABOUT, "speed: -2, max_torque: 3"),
        (SLIDER, SliderJoint, ALONG, "speed: -2, max_force: 3"),
    ],
)
def test_a_motor_and_limits_have_rows_of_their_own(
    joint: str, kind: type, moves: int, motor: str
) -> None:
    alone, found = joint_of(joint), joint_of(f"{joint}, limits: [-1, 2], motor: {{{motor}}}")
    assert isinstance(found, kind)
    assert alone.motor_row == alone.stop_rows == ()
    assert alone.rows == found.rows
    assert [row.direction for row in (*found.motor_row, *found.stop_rows)] == [
        moves,
        moves + 1,
        moves + 2,
    ]
    assert found.limits == (-1.0, 2.0)
    assert (found.motor.speed, found.motor.most) == (-2.0, 3.0)


@pytest.mark.parametrize(
    ("joint", "sentence"),
    [
        (f"{HINGE}, limits: [0.1, 1]", "limits: expected 0, where the run begins, between them"),
        (f"{HINGE}, limits: [1, -1]", "limits: expected 0"),
        (f"{HINGE}, limits: [0, 0]", "limits: expected 0"),
        (f"{HINGE}, limits: [-4, 4]", "limits: expected less than 6.283 rad"),
        (f"{HINGE}, limits: [1]", "limits: expected a list of 2 numbers [rad]"),
        (f"{SLIDER}, limits: [0, far]", "limits"),
        (f"{HINGE}, motor: {{speed: 1}}", 'missing key "max_torque"'),
        (f"{HINGE}, motor: {{speed: 1, max_force: 1}}", 'unknown key "max_force"'),
        (f"{SLIDER}, motor: {{speed: 1, max_torque: 1}}", 'unknown key "max_torque"'),
        (f"{SLIDER}, motor: {{speed: 1, max_force: -1}}", "max_force: expected a number of 0"),
        ("kind: ball, motor: {speed: 1, max_torque: 1}", 'unknown key "motor"'),
        ("kind: ball, limits: [-1, 1]", 'unknown key "limits"'),
        ("kind: fixed, motor: {speed: 1, max_torque: 1}", 'unknown key "motor"'),
    ],
)
def test_what_no_joint_can_have_is_refused_at_its_place(joint: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(TEXT.format(joint=joint), "x.yaml").cells()
    assert sentence in str(refused.value)
    assert "x.yaml:7:" in str(refused.value)


def test_limits_of_a_slider_may_be_as_far_as_they_like_and_those_of_a_hinge_once_round() -> None:
    assert joint_of(f"{SLIDER}, limits: [-40, 40]").stop_rows
    assert joint_of(f"{HINGE}, limits: [0, 6.28]").stop_rows
