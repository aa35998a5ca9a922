"""A ball on a plate that vibrates: at fixed timesteps its place is found to order 2.

It rides, leaves where the plate falls faster than it, flies and lands, or bounces. Truth is event-
driven: parabolas, and roots of their distance from the plate (Brent). What is of second order are
the plate's velocity at an impact, less h^2 w^2/12 of it, h the rest of the step, and the instant at
which the plate lets go.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import brentq
from shared_runs import GRAVITY, States, ball, config, orders, run_scenes

W, DURATION, RATES = 6.0 * math.pi, 0.9, (60, 120, 240, 480)


class Course(NamedTuple):
    """A ball above a plate A sin(w t); height 0: it rides from the start."""

    share: float  # of gravity, the plate's largest acceleration: A w^2/g [-]
    restitution: float
    height: float  # [m]

    @property
    def amplitude(self) -> float:
        return self.share * GRAVITY / W**2

    def text(self, rate: int) -> str:
        plate = (
            "{shape: {kind: box, size: [1, 1, 0.2]}, kinematic: true, position: [0, 0, -0.1], "
            f"surface: one, motion: [{{displacement: [0, 0, {self.amplitude!r}], "
            "factor: {kind: sine, frequency: 3}}]}"
        )
        speed = 0.0 if self.height else self.amplitude * W
        above = ball(0.1, 1.0, (0, 0, 0.1 + self.height), (0, 0, speed))
        bodies = {"plate": plate, "ball": above}
        surface = f"restitution: {self.restitution}, friction: 0.1"
        return config(bodies, rate, DURATION, surface, repr(GRAVITY))

    def truth(self, times: np.ndarray) -> np.ndarray:
        """Return the height of the ball's lowest point [m]."""
        a, found = self.amplitude, np.empty_like(times)
        t, z, v, rides = 0.0, self.height, 0.0, self.height == 0.0
        while t < DURATION:
            if rides:
                found[times >= t] = a * np.sin(W * times[times >= t])
                phase = math.asin(1.0 / self.share)  # A w^2 sin = g
                t += (phase - W * t) % math.tau / W
                z, v, rides = a * math.sin(W * t), a * W * math.cos(W * t), False
                continue
            flies = times >= t
            since = times[flies] - t
            found[flies] = z + v * since - 0.5 * GRAVITY * since**2

            def gap(s: float, t: float = t, z: float = z, v: float = v) -> float:
                return z + v * (s - t) - 0.5 * GRAVITY * (s - t) ** 2 - a * math.sin(W * s)

            grid = np.arange(t + 1e-4, DURATION + 1e-3, 1e-4)
            met = next((s for s in grid if gap(s) < 0.0), None)
            if met is None:
                break
            last, speed = t, v
            t = brentq(gap, met - 1e-4, met, xtol=1e-15)
            z, v = a * math.sin(W * t), a * W * math.cos(W * t)
            if self.restitution == 0.0:
                rides = True
            else:
                v -= self.restitution * (speed - GRAVITY * (t - last) - v)
        return found


COURSES = {
    "leaves and lands": Course(1.5, 0.0, 0.0),
    "bounces": Course(0.5, 0.8, 0.2),
}


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes({f"{k}|{r}": one.text(r) for k, one in COURSES.items() for r in RATES})


@pytest.mark.parametrize("name", COURSES)
def test_a_ball_on_a_vibrated_plate_is_found_to_order_2(ran: dict[str, States], name: str) -> None:
    """Where in a step it lands is another in each: half an order in three halvings."""
    errors = []
    for rate in RATES:
        states = ran[f"{name}|{rate}"]
        place = states.of("ball")[0][:, 2] - 0.1
        errors.append(float(np.abs(place - COURSES[name].truth(states.time)).max()))
    assert np.mean(orders(errors)) == pytest.approx(2.0, abs=0.5 / 3.0)
    assert errors[-1] < 0.001 * COURSES[name].amplitude + 1e-5
