"""When a motor has its speed, by its rate in the last part; one that holds has no instant."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from interpreted import interpreted
from plain_facts import one_row

from lavendersim.engine.approach import NEVER
from lavendersim.engine.motor_reach import (
    MOST_OF_A_PART,
    SPENT,
    make_first_reach,
    make_note_drive,
    reaches_speeds,
)
from lavendersim.engine.spec import Spec

SPEC = Spec(
    effects=(
        *(
            "compound",
            "contact_midpoint",
            "contact_torque",
            "error_control",
            "frictionless_contact",
        ),
        *("impact_order", "impact_time", "joint", "midpoint", "motor", "rotation"),
    ),
    shape_pairs=("sphere_sphere",),
)
REACH, NOTE = interpreted(make_first_reach(SPEC)), interpreted(make_note_drive(SPEC))
STEP, SPEED, RATE = 0.01, 3.0, 100.0  # [s], [rad/s], [rad/s^2]


def zeros(prefix: str) -> dict[str, float]:
    return dict.fromkeys([f"{prefix}{axis}" for axis in "xyz"], 0.0)


def motor(**fields: float) -> Any:
    """The row of a hinge's motor about z: its levers are the axis."""
    names = ("n", "arm_a", "arm_b", "lever_a", "lever_b")
    known = {key: value for name in names for key, value in zeros(name).items()}
    known |= dict.fromkeys(("arm_az", "arm_bz", "lever_az", "lever_bz"), 1.0)
    known |= {"motor": 1, "couple": 1, "pair": 0, "a": 0, "b": 1, "driven": 0.5}
    return one_row(**known | {"lambda_n": -0.2, "most": 0.2} | fields)


def spins(*values: float) -> list[Any]:
    return [one_row(**zeros("v"), **zeros("w") | {"wz": value}) for value in values]


def state_of(contact: Any, a: float, b: float, rate: float = RATE) -> Any:
    bodies = [one_row(drive_rate=rate) for _ in range(4)]
    pairs = [one_row(a=2, b=3, motor_speed=SPEED)]
    moving = {"motion": spins(a, b), "velocities": spins(a, b)}
    return SimpleNamespace(contacts=[contact], pairs=pairs, bodies=bodies, **moving)


def found(state: Any, left: float = STEP, spent: int = 0) -> float:
    counters, rows = one_row(spent=spent), len(state.contacts)
    when = float(REACH(state, rows, one_row(dt=left, timestep=STEP), counters))
    share = min(1 + rows, MOST_OF_A_PART)
    assert counters.spent == spent + (share if when < left else 0)
    return when


def test_parts_end_so_where_steps_have_parts_and_a_middle() -> None:
    assert reaches_speeds(SPEC)
    for name in ("motor", "contact_midpoint", "impact_order"):
        assert not reaches_speeds(SPEC.without(name))


def test_it_is_where_its_speed_and_rate_lead() -> None:
    assert found(state_of(motor(), 1.0, 3.5)) == pytest.approx(0.5 / RATE)
    assert found(state_of(motor(), 1.0, 4.5, -RATE)) == pytest.approx(0.5 / RATE)
    assert found(state_of(motor(), 1.0, 3.5), spent=SPENT) == NEVER
    assert found(state_of(motor(motor=0), 1.0, 3.5)) == NEVER


def test_of_hundreds_of_rows_it_counts_as_few() -> None:
    state = state_of(motor(), 1.0, 3.5)
    state.contacts += [motor(motor=0) for _ in range(2 * SPENT)]
    assert found(state) == pytest.approx(0.5 / RATE)
    assert found(state, spent=SPENT - MOST_OF_A_PART) == pytest.approx(0.5 / RATE)
    assert found(state, spent=SPENT - MOST_OF_A_PART + 1) == NEVER


@pytest.mark.parametrize(
    ("b", "rate"), [(2.5, RATE), (3.5, -RATE), (3.5, 0.0), (4.0, RATE), (4.0 - 1e-8, RATE)]
)
def test_there_is_none_beyond_the_step_away_from_it_or_where_it_has_it(
    b: float, rate: float
) -> None:
    assert found(state_of(motor(), 1.0, b, rate)) == NEVER


def test_of_a_slider_it_is_the_speed_of_ends_along_the_axis() -> None:
    axis = np.array([0.0, 0.6, 0.8])
    row = motor(couple=0, nx=axis[0], ny=axis[1], nz=axis[2], arm_bz=0.0, arm_az=0.0, arm_bx=0.5)
    state = state_of(row, 0.0, 2.0)
    state.motion[1].vz = 2.0  # 1.6 along the axis, and 0.6 of 2 rad/s at 0.5 m
    assert found(state) == pytest.approx((SPEED - 1.6 - 0.6) / RATE)


def test_the_rate_is_that_of_a_part_in_which_it_gave_its_most() -> None:
    params = one_row(dt=0.005, timestep=STEP)
    for row, expected in ((motor(), 200.0), (motor(lambda_n=0.19), 0.0), (motor(motor=0), RATE)):
        state = state_of(row, 1.0, 2.5)
        NOTE(state, 1, params)
        assert state.bodies[3].drive_rate == pytest.approx(expected)
        assert state.bodies[2].drive_rate == RATE
    state = state_of(motor(), 1.0, 2.5)
    NOTE(state, 1, one_row(dt=1e-9 * STEP, timestep=STEP))
    assert state.bodies[3].drive_rate == RATE  # of what took no time
