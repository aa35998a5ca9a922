"""What contacts push through a medium keeps to order 2: drag is that of both ends of a step.

Against ODEs of its way, by Runge and Kutta's rule of order 8 (DOP853) to 1e-12:
    a belt carries a block         v' = mu g - (c_1 + c_2 v) v/m
    a block slides down a slope    v' = g (sin - mu cos) - (c_1 + c_2 v) v/m
    a ball rolls down a slope      1.4 v' = g sin - ((c_1 + c_2 v) v + c v/r^2)/m
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import pytest
from scipy.integrate import solve_ivp
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

HALVED = (60, 120, 240, 480)  # steps a second
DURATION, LONG = 1.0, 12.0  # [s]
LINEAR, QUADRATIC, ANGULAR = 0.5, 0.8, 0.01  # [N s/m], [N s^2/m^2], [N m s]
RADIUS, SLOPE, FRICTION = 0.1, math.radians(20), 0.2
BOX, BALL = "{kind: box, size: [0.4, 0.4, 0.05]}", f"{{kind: sphere, radius: {RADIUS}}}"
SOLVED = 1e-9  # [m/s], of a step


class Pushed(NamedTuple):
    """A body of 1 kg, and what its speed obeys."""

    shape: str
    height: float  # [m] of its centre
    speed: float  # [m/s], as it begins
    belt: float  # [m/s]
    tilted: bool
    friction: float
    rate: Callable[[float], float]  # of its speed [m/s^2]


def drag(v: float) -> float:
    return (LINEAR + QUADRATIC * abs(v)) * v


def slides(v: float) -> float:
    return GRAVITY * (math.sin(SLOPE) - FRICTION * math.cos(SLOPE)) - drag(v)


def rolls(v: float) -> float:
    return (GRAVITY * math.sin(SLOPE) - drag(v) - ANGULAR * v / RADIUS**2) / 1.4


SCENES = {
    "carried": Pushed(BOX, 0.025, 0.0, 5.0, False, 0.3, lambda v: 0.3 * GRAVITY - drag(v)),
    "slides": Pushed(BOX, 0.025, 2.0, 0.0, True, FRICTION, slides),
    "rolls": Pushed(BALL, RADIUS, 0.0, 0.0, True, 0.6, rolls),
}


def scene(name: str, rate: int, duration: float = DURATION) -> str:
    shape, height, speed, belt, tilted, friction, _ = SCENES[name]
    medium = f"{{linear: {LINEAR}, quadratic: {QUADRATIC}, angular: {ANGULAR}}}"
    moves = f"surface_velocity: {flow((belt, 0, 0))}"
    bodies = {
        "floor": f"{{shape: {{kind: plane}}, surface: one, {moves}}}",
        "body": f"{{shape: {shape}, mass: 1, surface: one, position: {flow((0, 0, height))}, "
        f"velocity: {flow((speed, 0, 0))}, drag: {medium}}}",
    }
    gravity = f"{{tilt_degrees: {math.degrees(SLOPE)!r}}}" if tilted else repr(GRAVITY)
    return config(bodies, rate, duration, f"friction: {friction}", gravity)


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"{name} {rate}": scene(name, rate) for name in SCENES for rate in HALVED}
    return run_scenes(texts | {f"{name} long": scene(name, 60, LONG) for name in SCENES})


@pytest.mark.parametrize("name", SCENES)
def test_way_is_of_order_2(ran: dict[str, States], name: str) -> None:
    """Errors are c_2 dt^2 + c_3 dt^3: drag's map of a step is no symmetric one.

    Its terms are of the rate of drag, k = (c_1 + 2 c_2 v)/m < 4/s: c_3/c_2 < k, and an order is off
    by at most k dt / (2 ln 2) = 0.05 at 1/60 s where terms of one sign do not cancel; they do in
    c_2 of the ball to a fifth, which makes it 0.25. From 1/120 on half of that.
    """
    found = SCENES[name]
    course = solve_ivp(
        lambda _, y: (y[1], found.rate(y[1])), (0.0, DURATION), (0.0, found.speed),
        method="DOP853", rtol=1e-12, atol=1e-13,
    )  # fmt: skip
    errors = [abs(ran[f"{name} {r}"].of("body")[0][-1, 0] - course.y[0, -1]) for r in HALVED]
    assert orders(errors)[1:] == pytest.approx([2.0] * 2, abs=0.25)
    assert errors[-1] < 1e-5


@pytest.mark.parametrize("name", SCENES)
def test_it_ends_at_the_speed_at_which_drag_carries_the_push(
    ran: dict[str, States], name: str
) -> None:
    """Both ends of a step are then alike, and the timestep does not enter.

    After 12 s, 20 times 1/k, e^-20 is left of 2 m/s; of what a solve leaves k dt is kept a step,
    so that of SOLVED in each 1/(k dt) = 40 add up.
    """
    last = ran[f"{name} long"].of("body")[1][-1, 0]
    assert SCENES[name].rate(last) == pytest.approx(0.0, abs=4.0 * 40.0 * SOLVED + 2e-8)
