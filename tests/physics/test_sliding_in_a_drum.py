"""What slides in a drum, turns round and slides back, by its ODE; at a timestep, and as accurately.

A ball that does not turn (its moment of inertia is large) is a point at L = R - r from the axis:

    L q'' = -g sin q - sign(q') mu (g cos q + L q'^2)

Its slip passes through 0 where the wall is steep, and friction changes its sign within a step. As
the wall turns ahead of it, contacts at the middle of steps leave it a velocity across the wall that
changes its sign from step to step: no reason to overlook a stop, nor an error that asks for shorter
substeps.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes
from test_error_control import asking

R, RADIUS, MU = 1.0, 0.1, 0.2  # [m], [m], [-]
ARM, RELEASED = R - RADIUS, 1.2  # [m], [rad]
RATES = (60, 120, 240, 480)  # steps a second
ACCURACIES = (1e-4, 1e-5)
DURATION = 1.4  # [s]; it turns round at 0.998 s


def scene(rate: int) -> str:
    drum = (
        f"{{shape: {{kind: drum, radius: {R}}}, position: [0, 0, 0], surface: one, fixed: true, "
        "orientation: {axis: [1, 0, 0], degrees: 90}}"
    )
    at = flow((ARM * math.sin(RELEASED), 0.0, -ARM * math.cos(RELEASED)))
    it = (
        f"{{shape: {{kind: sphere, radius: {RADIUS}}}, mass: 1, position: {at}, surface: one, "
        "inertia: [1e9, 1e9, 1e9]}"
    )
    return config({"drum": drum, "it": it}, rate, DURATION, f"friction: {MU}", repr(GRAVITY))


def slide(begin: float, q: float, sign: float, end: float):
    """Return a slide from rest, up to where it stops or `end`; sign: of its velocity."""

    def law(_: float, state: np.ndarray) -> tuple[float, float]:
        pressed = GRAVITY * math.cos(state[0]) + ARM * state[1] ** 2
        return state[1], -(GRAVITY * math.sin(state[0]) + sign * MU * pressed) / ARM

    def stops(_: float, state: np.ndarray) -> float:
        return sign * state[1]

    stops.terminal, stops.direction = True, -1.0
    return solve_ivp(
        law,
        (begin, end),
        (q, sign * 1e-13),
        events=stops,
        dense_output=True,
        rtol=1e-12,
        atol=1e-13,
    )


@pytest.fixture(scope="module")
def truth():
    """Return the angle at any times, and the path up to the end [m]."""
    there = slide(0.0, RELEASED, -1.0, DURATION)
    turned = float(there.y[0, -1])
    back = slide(there.t[-1], turned, 1.0, 2.0 * DURATION)

    def angle(times: np.ndarray) -> np.ndarray:
        return np.where(times < there.t[-1], there.sol(times)[0], back.sol(times)[0])

    # It slides back: friction does not hold it.
    assert 0.9 < there.t[-1] < 1.1
    assert math.tan(-turned) > MU
    return angle, ARM * (RELEASED - turned + float(angle(np.array(DURATION))) - turned)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes({str(rate): scene(rate) for rate in RATES})


def off(states: States, truth) -> float:
    """Return how far it is off at the worst time, as a share of its path."""
    place, _, _ = states.of("it")
    angle, path = truth
    found = np.arctan2(place[:, 0], -place[:, 2])
    return float(ARM * abs(found - angle(states.time)).max() / path)


def test_it_turns_round_at_second_order_whatever_the_phase_of_the_step(ran, truth) -> None:
    errors = [off(ran[str(rate)], truth) for rate in RATES]
    # A stop that is overlooked has the friction of before for up to a step: mu g dt of velocity,
    # of first order. The next term of a smooth error is a share w dt = 0.06 of it, and halves.
    assert orders(errors) == pytest.approx([2.0, 2.0, 2.0], abs=0.15)
    assert [int((ran[str(rate)].step["parts"] > 1).sum()) for rate in RATES] == [1] * len(RATES)


def test_it_is_as_accurate_as_asked_for_in_as_many_substeps_as_that_takes(truth) -> None:
    texts = {repr(accuracy): asking(scene(60), accuracy) for accuracy in ACCURACIES}
    states = run_scenes(texts)
    for accuracy in ACCURACIES:
        assert 0.1 * accuracy <= off(states[repr(accuracy)], truth) <= 10.0 * accuracy
    few, many = (int(states[repr(accuracy)].step["substeps"].sum()) for accuracy in ACCURACIES)
    # Of second order: sqrt(10) = 3.2 times as many for a tenth, and not ten, as of first order.
    assert many <= 4.0 * few
