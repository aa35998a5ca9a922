"""What a varying force does to a body at rest in one step: at a point, in either frame."""

from __future__ import annotations

import numpy as np
import pytest
from convex import matrix_of
from interpreted import interpreted, records
from interpreted_steps import Steps
from laboratory import body, resolved
from plain_facts import one_row

from lavendersim.engine.effects.varying_force import make_pushes, make_step_row
from lavendersim.engine.record_layout import allocate_bodies, step_row_dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("midpoint", "pose_log", "rotation", "step_log", "varying_force"))
BRICK = {"kind": "box", "size": [0.2, 0.3, 0.5]}
TURN = np.array((0.8, 0.2, -0.4, 0.4))
FORCE, TORQUE, POINT = np.array([3.0, -1.0, 2.0]), np.array([0.1, 0.3, -0.2]), (0.05, 0.1, -0.2)


@pytest.mark.parametrize("frame", ["world", "body"])
def test_a_force_at_a_point_pushes_and_turns_in_its_frame(frame: str) -> None:
    """m v = F dt and I w = (T + r x F) dt, where the step begins without a spin."""
    cell = resolved({"one": body(BRICK, mass=1.3, orientation=TURN.tolist())}, timestep="1/50")
    factor = {"kind": "ramp", "rate": 4.0, "from": 0.0}
    cell["scene"]["forces"] = [
        {"body": "one", "from": 0.0, "to": 9.0, "force": FORCE.tolist(), "torque": TORQUE.tolist(),
         "point": POINT, "frame": frame, "factor": factor}
    ]  # fmt: skip
    steps = Steps(cell, SPEC)
    steps.run(1)
    matrix = matrix_of(TURN / np.linalg.norm(TURN))
    seen = matrix if frame == "body" else np.eye(3)
    share = 0.5 * 4.0 / 50.0**2  # the integral of the factor
    force, torque = share * seen @ FORCE, share * seen @ TORQUE
    np.testing.assert_allclose(1.3 * steps.velocities[0], force, atol=1e-15)
    inertia = matrix @ np.diag(cell["scene"]["bodies"]["one"]["inertia"]) @ matrix.T
    moment = inertia @ steps.vectors(steps.engine.velocities, "w")[0]
    # Its frame and its lever turn by w dt/2 on the way: 0.04 rad/s for 0.01 s.
    expected = torque + np.cross(matrix @ POINT, force)
    np.testing.assert_allclose(moment, expected, atol=1e-3 * np.linalg.norm(expected))


NAMES = [f"{name}_{axis}" for name in ("force", "torque") for axis in "xyz"]


@pytest.mark.parametrize("own", ["", *NAMES])
def test_a_body_is_pushed_where_any_part_of_force_or_torque_is_not_zero(own: str) -> None:
    fields = dict.fromkeys(NAMES, 0.0) | ({own: -1e-300} if own else {})
    assert bool(interpreted(make_pushes(SPEC))(one_row(**fields))) == bool(own)


def test_a_step_has_the_work_and_the_impulse_of_all_bodies(rng) -> None:
    bodies, row = allocate_bodies(SPEC, 3), np.zeros(1, step_row_dtype(SPEC))
    names = ("worked", "pushed_x", "pushed_y", "pushed_z")
    for name in names:
        bodies[name] = rng.normal(size=3)
    interpreted(make_step_row(SPEC))(records(row)[0], records(bodies), None)
    found = [row[name][0] for name in ("force_work", *(f"force_impulse_{a}" for a in "xyz"))]
    assert found == pytest.approx([bodies[name].sum() for name in names], rel=1e-14)


def test_the_work_of_a_part_begins_where_the_body_stands() -> None:
    moving = {"velocity": (1.0, 2.0, 3.0), "angular_velocity": (3.0, -2.0, 1.0)}
    brick = body(BRICK, (0.3, 0.2, -0.1), orientation=TURN.tolist(), **moving)
    steps = Steps(resolved({"one": brick}), SPEC)
    names = ("x", "y", "z", "qw", "qx", "qy", "qz")
    before = [float(steps.engine.bodies[name][0]) for name in names]
    steps.run(1)
    assert [float(steps.engine.bodies[f"from_{name}"][0]) for name in names] == before
