"""Bodies leave what they roll or slide on where its reaction ends, at second order in the timestep.

A ball on a ball; balls, cylinders and capsules over the edge of a box: truth is an independent
integration of the constraint (Runge-Kutta of order 4) with Coulomb's friction, then flight. All
scenes are run in one engine.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, run_scenes

RATES = (240, 480, 1000)  # steps a second
STRIDE = 5e-5  # of the integration [s]
BELOW, RADIUS, SECONDS = 0.3, 0.1, 0.7  # [m], [m], [s]
BEFORE = 0.5  # it reaches the edge after that time [s]
ON_BALL = {"slides": 0.0, "slips": 0.3, "rolls": 1.0}  # coefficient of friction
OVER_EDGE = {  # friction, speed [m/s]
    "ball": [(0.0, 0.7), (0.0, 0.9), (0.5, 0.05), (0.5, 0.7), (0.5, 0.9)],
    "cylinder": [(0.0, 0.35), (0.0, 0.7), (0.5, 0.05), (0.5, 0.1), (0.5, 0.35), (0.5, 0.7)],
    "capsule": [(0.5, 0.05), (0.5, 0.35), (0.5, 0.7)],
}
LENGTH = 0.2  # of cylinders, and of the axis of capsules [m]
LYING = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)  # along y
TUBE, BALL = LENGTH, 4.0 / 3.0 * RADIUS  # shares of a capsule's volume, over pi r^2 [m]
INERTIA = {  # about the axis, over m r^2
    "ball": 0.4,
    "cylinder": 0.5,
    "capsule": (0.5 * TUBE + 0.4 * BALL) / (TUBE + BALL),
}
SHAPES = {
    "ball": f"{{kind: sphere, radius: {RADIUS}}}",
    "cylinder": f"{{kind: cylinder, radius: {RADIUS}, length: {LENGTH}}}",
    "capsule": f"{{kind: capsule, radius: {RADIUS}, length: {LENGTH}}}",
}


def rates_of(
    motion: np.ndarray, away: float, inertia: float, friction: float, sticks: bool
) -> np.ndarray:
    """Return the rates of (angle, its rate, spin, pressure's rest); away: of the centres [m]."""
    angle, rate, _ = motion
    if sticks:
        turning = GRAVITY * math.sin(angle) / (away * (1.0 + inertia))
        return np.array([rate, turning, away * turning / RADIUS])
    force = friction * pressure(motion, away)
    if away * rate < motion[2] * RADIUS:
        force = -force
    turning = (GRAVITY * math.sin(angle) - force) / away
    return np.array([rate, turning, force / (inertia * RADIUS)])


def pressure(motion: np.ndarray, away: float) -> float:
    """Return the normal force of a body of 1 kg [N]."""
    return GRAVITY * math.cos(motion[0]) - away * motion[1] ** 2


def truth(
    shape: str, away: float, friction: float, start: tuple[float, float], seconds: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return place and velocity from the centre of what it goes round, and spin, at the end.

    start: angle from the vertical, and speed; it rolls where there is friction.
    """
    angle, speed = start
    inertia = INERTIA[shape]
    motion = np.array([angle, speed / away, speed / RADIUS if friction > 0.0 else 0.0])
    sticks, time = friction > 0.0, 0.0
    # Half a stride less than all: else round-off may add one.
    while pressure(motion, away) > 0.0 and time < seconds - 0.5 * STRIDE:
        if sticks:
            held = GRAVITY * math.sin(motion[0]) * inertia / (1.0 + inertia)
            sticks = held <= friction * pressure(motion, away)
        law = away, inertia, friction, sticks
        one = rates_of(motion, *law)
        two = rates_of(motion + 0.5 * STRIDE * one, *law)
        three = rates_of(motion + 0.5 * STRIDE * two, *law)
        four = rates_of(motion + STRIDE * three, *law)
        motion = motion + STRIDE / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        time += STRIDE
    left = seconds - time
    out = np.array([math.sin(motion[0]), 0.0, math.cos(motion[0])])
    along = np.array([math.cos(motion[0]), 0.0, -math.sin(motion[0])])
    velocity, down = away * motion[1] * along, np.array([0.0, 0.0, -GRAVITY])
    place = away * out + left * velocity + 0.5 * left**2 * down
    return place, velocity + left * down, motion[2]


def rolling(shape: str, place: tuple[float, ...], speed: float, friction: float) -> str:
    spin = speed / RADIUS if friction > 0.0 else 0.0
    return (
        f"{{shape: {SHAPES[shape]}, mass: 1.0, surface: one, position: {flow(place)}, "
        f"orientation: {flow(LYING)}, velocity: {flow((speed, 0, 0))}, "
        f"angular_velocity: {flow((0, spin, 0))}}}"
    )


def on_ball(friction: float, rate: int) -> str:
    """A ball is released at rest on another, 12 degrees from its top."""
    angle, away = math.radians(12.0), BELOW + RADIUS
    below = f"{{shape: {{kind: sphere, radius: {BELOW}}}, fixed: true, surface: one}}"
    below = below.replace("fixed", "position: [0, 0, 0], fixed")
    place = (away * math.sin(angle), 0.0, away * math.cos(angle))
    bodies = {"below": below, "ball": rolling("ball", place, 0.0, friction)}
    return config(bodies, rate, SECONDS, surface=f"friction: {friction}", gravity=repr(GRAVITY))


def over_edge(shape: str, friction: float, speed: float, rate: int) -> str:
    """A body goes over the edge x = 0 of a table whose top is z = 0."""
    table = "{shape: {kind: box, size: [1, 1, 1]}, fixed: true, surface: one, position: "
    bodies = {
        "table": table + "[-0.5, 0, -0.5]}",
        "ball": rolling(shape, (-BEFORE * speed, 0.0, RADIUS), speed, friction),
    }
    return config(bodies, rate, SECONDS, surface=f"friction: {friction}", gravity=repr(GRAVITY))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"{name} {rate}": on_ball(ON_BALL[name], rate) for name in ON_BALL for rate in RATES}
    texts |= {
        f"{shape} {friction} {speed} {rate}": over_edge(shape, friction, speed, rate)
        for shape, each in OVER_EDGE.items()
        for friction, speed in each
        for rate in RATES
    }
    return run_scenes(texts)


def missed(states: States, found: tuple[np.ndarray, np.ndarray, float]) -> float:
    """Return the largest error at the end, of places [m] and speeds [m/s]."""
    place, velocity, spin = (each[-1] for each in states.of("ball"))
    off = *(place - found[0]), *(velocity - found[1]), RADIUS * (spin[1] - found[2])
    return float(np.abs(off).max())


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("name", ON_BALL)
def test_ball_leaves_a_ball_where_its_weight_no_longer_bends_its_path(
    ran: dict[str, States], name: str, rate: int
) -> None:
    """The reaction ends at the rate 3 g sin(angle) v/away = 94 N/s: half of it by dt^2 is lost.

    As much again for where it begins to slip.
    """
    found = truth("ball", BELOW + RADIUS, ON_BALL[name], (math.radians(12.0), 0.0), SECONDS)
    assert missed(ran[f"{name} {rate}"], found) < 94.0 / rate**2


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize(
    ("shape", "friction", "speed"),
    [(shape, *one) for shape, each in OVER_EDGE.items() for one in each],
)
def test_body_goes_over_an_edge_and_leaves_it(
    ran: dict[str, States], shape: str, friction: float, speed: float, rate: int
) -> None:
    """The step that crosses the edge leaves a gap, and the body lands once, no faster than g dt.

    It leaves at g sin(angle) v/away 3 < 130 N/s; what landing loses, (g dt)^2/(2 v) at most, has
    grown by e^(0.2 s sqrt(g/R)/sqrt(1.4)) < 6 where friction drives the fall. What is slow has
    come away by up to the slop of 1e-7 m: of its speed g slop/v, 2e-5 m/s, grown as much.
    """
    found = truth(shape, RADIUS, friction, (0.0, speed), round(SECONDS - BEFORE, 12))
    assert missed(ran[f"{shape} {friction} {speed} {rate}"], found) < 150.0 / rate**2
