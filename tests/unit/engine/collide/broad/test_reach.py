"""A body reaches |v| dt + |omega| R dt, and what gravity adds in two steps where it can fall."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.collide.broad.reach import make_reach
from lavendersim.engine.record_layout import allocate_parameters
from lavendersim.engine.records import ANGULAR_VELOCITY, BODY, VELOCITY, dtype
from lavendersim.engine.spec import Spec

DT = 0.01  # [s]
VELOCITY_OF_SPRINGS = dtype(VELOCITY, [("released", "f8")])


def reach_of(
    effects=("rotation",), inv_m=1.0, v=(0, 0, 0), omega=(0, 0, 0), g=(0, 0, 0), bound=0.5
):
    body, velocity = np.zeros(1, dtype(BODY)), np.zeros(1, dtype(VELOCITY, ANGULAR_VELOCITY))
    parameters = allocate_parameters()
    body["inv_m"], body["bound"], parameters["dt"] = inv_m, bound, DT
    for axis, *values in zip("xyz", v, omega, g, strict=True):
        velocity[f"v{axis}"], velocity[f"w{axis}"], parameters[f"g{axis}"] = values
    reach = interpreted(make_reach(Spec(effects)))
    return reach(records(body)[0], records(velocity)[0], records(parameters)[0])


def test_displacement_turn_and_fall_add_up() -> None:
    """5 m/s and 13 rad/s at half a metre for 10 ms; 7 m/s^2 in 20 ms: twice g dt^2."""
    assert reach_of(v=(3, 0, -4)) == pytest.approx(5 * DT, rel=1e-15)
    assert reach_of(v=(0, 5, 0)) == pytest.approx(5 * DT, rel=1e-15)
    assert reach_of(omega=(3, -4, 12)) == pytest.approx(13 * 0.5 * DT, rel=1e-15)
    assert reach_of(g=(2, 3, -6)) == pytest.approx(2 * 7 * DT**2, rel=1e-15)
    whole = reach_of(v=(3, 0, -4), omega=(3, -4, 12), g=(2, 3, -6))
    assert whole == pytest.approx(5 * DT + 6.5 * DT + 14 * DT**2, rel=1e-15)


def test_what_nothing_can_push_does_not_fall_and_what_cannot_turn_does_not_turn() -> None:
    assert reach_of(inv_m=0.0, v=(1, 2, 2), g=(0, 0, -9.81)) == pytest.approx(3 * DT, rel=1e-15)
    assert reach_of(effects=(), omega=(3, -4, 12)) == 0.0


def test_what_a_spring_may_give_counts_as_speed() -> None:
    spec, velocity = Spec(("compliance", "contact_spring")), np.zeros(1, VELOCITY_OF_SPRINGS)
    body, parameters = np.zeros(1, dtype(BODY)), allocate_parameters()
    parameters["dt"], velocity["vx"], velocity["released"] = DT, 3.0, 0.7
    reach = interpreted(make_reach(spec))
    found = reach(records(body)[0], records(velocity)[0], records(parameters)[0])
    assert found == pytest.approx(3.7 * DT, rel=1e-15)


def test_no_point_of_a_body_in_flight_leaves_its_reach(rng) -> None:
    """A point at R from the centre, turned by omega dt exactly while the centre falls for a step.

    The velocity counts at the step's end, so that gravity adds at most g dt^2; the chord of the
    turn is no longer than its arc.
    """
    for _ in range(50):
        v, omega, g, arm = rng.normal(size=(4, 3)) * [[2.0], [30.0], [9.81], [1.0]]
        spin = np.linalg.norm(omega)
        k, angle = omega / spin, spin * DT
        turned = (
            arm * np.cos(angle)
            + np.cross(k, arm) * np.sin(angle)
            + k * (k @ arm) * (1 - np.cos(angle))
        )
        moved = np.linalg.norm((v + g * DT) * DT + turned - arm)
        assert moved <= reach_of(v=v, omega=omega, g=g, bound=np.linalg.norm(arm))
