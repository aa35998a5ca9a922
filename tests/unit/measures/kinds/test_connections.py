"""What a rope pulls by, or a joint passes on: the mean, or the largest, of a run's last window."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from lavendersim.engine.effects.joint_models import BallJoint
from lavendersim.measures import evaluate
from lavendersim.measures.specs.connections import JointForce, JointTorque, Tension

DT = 0.01


def log() -> SimpleNamespace:
    """Ten steps: rope 1 pulls with 2 N, once 4 N; rope 2 with 7 N in the last; surfaces touch."""
    pulls = [(step, 1, 2.0) for step in range(1, 9)] + [(9, 1, 4.0), (10, 2, 7.0), (10, 0, 100.0)]
    contact = np.zeros(
        len(pulls), [("step", "i8"), ("rope", "i8"), ("force_n", "f8"), ("impulse_n", "f8")]
    )
    contact["step"], contact["rope"], contact["force_n"] = zip(*pulls, strict=True)
    contact["impulse_n"] = DT * contact["force_n"]
    step = np.zeros(11, [("step", "i8"), ("time", "f8")])
    step["step"], step["time"] = np.arange(11), DT * np.arange(11)
    ropes = {
        name: SimpleNamespace(between=between)
        for name, between in {"idle": "ww", "line": "wb", "leash": "bw"}.items()
    }
    bodies = {"w": SimpleNamespace(fixed=True), "b": SimpleNamespace(fixed=False)}
    scene = SimpleNamespace(connections=ropes, bodies=bodies)
    return SimpleNamespace(step=step, contact=contact, config=SimpleNamespace(scene=scene))


def tension(connection: str, last: float = 0.04, **more: str) -> float:
    spec = Tension(kind="tension", connection=connection, last=last, **more)
    return evaluate(spec, log())


def test_it_is_the_mean_of_the_window_slack_steps_included() -> None:
    # Steps 7 to 10: 2, 2, 4 and 0 N.
    assert tension("line") == pytest.approx(2.0, rel=1e-15)
    assert tension("leash") == pytest.approx(7.0 / 4.0, rel=1e-15)


def test_the_largest_is_that_of_a_step() -> None:
    assert tension("line", statistic="largest") == 4.0
    assert tension("line", last=0.01, statistic="largest") == 0.0


def test_what_pulls_nothing_and_a_window_beyond_the_run_have_none() -> None:
    assert math.isnan(tension("idle"))
    assert math.isnan(tension("line", last=1.0))


def joint_force(connection: str, last: float = 0.04, **more: str) -> float:
    """Ten steps of joint 1: (3, 0, -4) N, in the last (3, 12, 4); joint 0 holds nothing."""
    rows = [
        (step, 1, axis, force)
        for step in range(1, 11)
        for axis, force in enumerate((3.0, 0.0, -4.0) if step < 10 else (3.0, 12.0, 4.0))
    ]
    names = ("step", "joint", "nx", "ny", "nz", "force_n")
    contact = np.zeros(len(rows), [(n, "i8" if n in names[:2] else "f8") for n in names])
    for out, (step, joint, axis, force) in zip(contact, rows, strict=True):
        out["step"], out["joint"], out["force_n"] = step, joint, force
        out[names[2 + axis]] = 1.0
    made = log()
    joints = {
        name: BallJoint.model_construct(kind="ball", between=tuple(between))
        for name, between in {"idle": "ww", "arm": "wb"}.items()
    }
    made.contact, made.config.scene.connections = contact, joints
    return evaluate(JointForce(kind="joint_force", connection=connection, last=last, **more), made)


def test_force_of_a_joint_is_the_magnitude_of_its_mean_or_the_largest_of_a_step() -> None:
    # Steps 7 to 10: (3, 0, -4) three times and (3, 12, 4): mean (3, 3, -2).
    assert joint_force("arm") == pytest.approx(22.0**0.5, rel=1e-15)
    assert joint_force("arm", statistic="largest") == 13.0
    assert math.isnan(joint_force("idle"))
    assert math.isnan(joint_force("arm", last=1.0))


def test_torque_of_a_joint_is_about_its_first_row_of_each_step() -> None:
    """5 N up at the joint, which moves along x, and 2 N down 3 m beside it: 6 N m, then 12.

    What acts at the joint itself has no torque about it, wherever it is.
    """
    names = ("step", "joint", "x", "y", "z", "nx", "ny", "nz", "force_n")
    contact = np.zeros(20, [(n, "i8" if n in names[:2] else "f8") for n in names])
    contact["step"], contact["joint"], contact["nz"] = np.repeat(np.arange(1, 11), 2), 1, 1.0
    contact["x"] = 0.5 * contact["step"]
    contact["y"][1::2], contact["force_n"] = 3.0, np.tile([5.0, -2.0], 10)
    contact["force_n"][-2:] *= 2.0
    made = log()
    arm = BallJoint.model_construct(kind="ball", between=("w", "b"))
    made.contact, made.config.scene.connections = contact, {"arm": arm}

    def torque(**more: str) -> float:
        spec = JointTorque(kind="joint_torque", connection="arm", last=0.02, **more)
        return evaluate(spec, made)

    assert torque() == pytest.approx(9.0, rel=1e-15)
    assert torque(statistic="largest") == pytest.approx(12.0, rel=1e-15)
