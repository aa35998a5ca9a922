"""A body that begins to turn about its contact does so at second order from its first step.

As long as nothing turns, a step has no contacts at its middle. Its places and its turn are both the
mean of the step's velocities: else the point that it turns about, which friction holds, would slip
in every such step, and that is an error of first order.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

RATES = (120, 240, 480)  # steps a second
WIDTH, HEIGHT = 0.05, 0.3  # half width, half height of the block [m]
ALPHA = math.atan2(WIDTH, HEIGHT)
RELEASED = 1.1 * ALPHA  # beyond its balance, at rest
RADIUS, THICKNESS, LENGTH, TILT = 0.2, 0.02, 0.8, 0.3  # of a plank on a fixed cylinder
DURATION = 0.5


def turned(angle: float) -> str:
    return flow((math.cos(angle / 2.0), 0.0, math.sin(angle / 2.0), 0.0))


def block(rate: int) -> str:
    """The block stands on one edge, which is at the origin."""
    c, s = math.cos(RELEASED), math.sin(RELEASED)
    centre = (-WIDTH * c + HEIGHT * s, 0.0, WIDTH * s + HEIGHT * c)
    size = flow((2.0 * WIDTH, 0.2, 2.0 * HEIGHT))
    bodies = {
        "floor": "{shape: {kind: plane}, surface: one}",
        "body": f"{{shape: {{kind: box, size: {size}}}, mass: 1.0, surface: one, "
        f"position: {flow(centre)}, orientation: {turned(RELEASED)}}}",
    }
    return config(bodies, rate, DURATION, surface="friction: 5", gravity=repr(GRAVITY))


def plank(rate: int) -> str:
    """The plank has rolled from its balance on top of the cylinder, and is released."""
    c, s, off = math.cos(TILT), math.sin(TILT), RADIUS * TILT
    centre = ((RADIUS + THICKNESS) * s - off * c, 0.0, (RADIUS + THICKNESS) * c + off * s)
    lying = flow((math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0))
    bodies = {
        "log": f"{{shape: {{kind: cylinder, radius: {RADIUS}, length: 1.0}}, surface: one, "
        f"fixed: true, position: [0, 0, 0], orientation: {lying}}}",
        "body": f"{{shape: {{kind: box, size: {flow((LENGTH, 0.2, 2.0 * THICKNESS))}}}, "
        f"mass: 1.0, surface: one, position: {flow(centre)}, orientation: {turned(TILT)}}}",
    }
    return config(bodies, rate, DURATION, surface="friction: 2", gravity=repr(GRAVITY))


def block_turns(angle: float, rate: float) -> float:
    """Return its acceleration: of the moment of a rod of length 2 R about its edge, 4/3 R^2."""
    del rate
    return 0.75 * GRAVITY / math.hypot(WIDTH, HEIGHT) * math.sin(angle - ALPHA)


def plank_turns(angle: float, rate: float) -> float:
    """Return its acceleration by Lagrange, its centre at (R + h) n - R angle t (n, t turn)."""
    inertia = (LENGTH**2 + 4.0 * THICKNESS**2) / 12.0 + THICKNESS**2 + (RADIUS * angle) ** 2
    slope = RADIUS * angle * math.cos(angle) - THICKNESS * math.sin(angle)  # of the height
    return (-(RADIUS**2) * angle * rate**2 - GRAVITY * slope) / inertia


def integrated(acceleration, angle: float) -> float:  # type: ignore[no-untyped-def]
    """Return the angle after DURATION from rest, by Runge and Kutta's fourth order."""
    count, rate = 4000, 0.0
    h = DURATION / count
    for _ in range(count):
        k1 = (rate, acceleration(angle, rate))
        k2 = (rate + h / 2 * k1[1], acceleration(angle + h / 2 * k1[0], rate + h / 2 * k1[1]))
        k3 = (rate + h / 2 * k2[1], acceleration(angle + h / 2 * k2[0], rate + h / 2 * k2[1]))
        k4 = (rate + h * k3[1], acceleration(angle + h * k3[0], rate + h * k3[1]))
        angle += h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        rate += h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
    return angle


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"block {rate}": block(rate) for rate in RATES}
    return run_scenes(texts | {f"plank {rate}": plank(rate) for rate in RATES})


def angles(states: States) -> np.ndarray:
    turn = states.turn[:, states.names.index("body")]
    return 2.0 * np.arctan2(turn[:, 2], turn[:, 0])


@pytest.mark.parametrize("rate", RATES)
def test_the_edge_that_friction_holds_does_not_slip_in_the_first_steps(
    ran: dict[str, States], rate: int
) -> None:
    states = ran[f"block {rate}"]
    angle, (place, _, _) = angles(states)[:6], states.of("body")
    edge = place[:6, 0] + WIDTH * np.cos(angle) - HEIGHT * np.sin(angle)
    # Five steps turn it by 25/2 of a dt^2, a = 0.75 g sin(0.1 alpha)/R, 0.4 rad/s^2. What the
    # chord of an arc and its tangent differ by is of that turn's third power; else R times the
    # turn of the first step, half a dt^2, would be off: 4e-6 m at 1/120, 3e-7 m at 1/480.
    turn = 12.5 * block_turns(RELEASED, 0.0) / rate**2
    allowed = math.hypot(WIDTH, HEIGHT) * turn**3 + 5.0 * 1e-9 / rate  # 1e-9 m/s: solved
    assert allowed < 1e-9
    assert abs(edge).max() <= allowed


@pytest.mark.parametrize(
    ("name", "acceleration", "start"),
    [("block", block_turns, RELEASED), ("plank", plank_turns, TILT)],
)
def test_angle_is_of_order_2(
    ran: dict[str, States],
    name: str,
    acceleration,
    start: float,  # type: ignore[no-untyped-def]
) -> None:
    exact = integrated(acceleration, start)
    errors = [abs(angles(ran[f"{name} {rate}"])[-1] - exact) for rate in RATES]
    # The next term of the series has (p dt)^2 of the first one's share, p = 5/s: 2e-3 at 1/120.
    # What steps of 1e-9 m/s leave adds up to 0.1 um of a radius of 0.3 m: 1e-2 of the finest error.
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.1)
