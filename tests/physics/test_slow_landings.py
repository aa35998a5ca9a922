"""Balls that land slower than g dt, by the closed form of their bounces.

Let go at a height from which a fall takes a part of a step, so that bounces end within steps: of
speeds v, e v, e^2 v, ... at the surface, between parabolas. A ball alone over a plane, which has no
order of impacts, and one of two.
"""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import run_config
from shared_runs import GRAVITY, ball, config, plane

from lavendersim.engine.foreseen_impacts import FALL

STEPS, RADIUS = 24, 0.1
SHARES = (0.05, 0.3, 0.6, 0.95)  # of a step, that the fall takes
SHORTEST = 1.0 / 64.0  # flight, in steps: a rebound that takes less is contact


def height_and_speed(fall: float, e: float, t: float, shortest: float) -> tuple[float, float]:
    """Return height above the plane and speed at t; fall: time of the first fall [s]."""
    if t <= fall:
        return 0.5 * GRAVITY * (fall**2 - t**2), GRAVITY * t
    t, flight = t - fall, 2.0 * fall * e
    while flight > shortest:
        if t < flight:
            return 0.5 * GRAVITY * t * (flight - t), GRAVITY * abs(0.5 * flight - t)
        t, flight = t - flight, flight * e
    return 0.0, 0.0


@pytest.mark.parametrize("alone", [True, False])
@pytest.mark.parametrize("rate", [60, 240])
@pytest.mark.parametrize("e", [0.0, 0.3, 0.8, 1.0])
def test_ball_bounces_and_rests_as_its_closed_form(e: float, rate: int, alone: bool) -> None:
    for share in SHARES:
        fall = share / rate
        if not alone and e == 0.0 and 0.5 * GRAVITY * fall**2 < FALL:
            continue  # that is contact, and comes to rest within the slop
        at = (0.0, 0.0, RADIUS + 0.5 * GRAVITY * fall**2)
        bodies = {"floor": plane(), "ball": ball(RADIUS, 1.0, at)}
        if not alone:
            bodies["other"] = ball(RADIUS, 1.0, (1.0, 0.0, RADIUS))
        text = config(bodies, rate, STEPS / rate, f"restitution: {e}", f"{GRAVITY}")
        (course,) = run_config(text, interpreted=True)
        steps = range(len(course.step))
        exact = [height_and_speed(fall, e, k / rate, SHORTEST / rate) for k in steps]
        height, speed = (np.array(column) for column in zip(*exact, strict=True))
        # Places near 0.1 m are rounded by 1e-17 a step, which is a time of 1e-17 m/v; where a step
        # ends at an impact, its speed is that of before or after.
        fastest = GRAVITY * fall
        assert course.height("ball") - RADIUS == pytest.approx(height, abs=1e-13)
        got = np.sqrt(2.0 * course.step["kinetic_energy"])
        assert got == pytest.approx(speed, abs=1e-7 * fastest + 1e-12)
