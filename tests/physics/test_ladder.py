"""A ladder between a smooth wall and a smooth floor: of its two contacts each presses the other.

No force acts along the wall's normal. A uniform rod of length L, at the angle theta to the floor:
    theta'' = -3 g/(2 L) cos(theta),    x'' = 0 of its centre, where it leaves the wall:
    sin(theta) = 2/3 sin(theta_0)
from there it keeps the speed that its centre has along the floor.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

RATES = (60, 120, 240)  # steps a second
LENGTH, RADIUS, LAST = 1.0, 0.01, 0.25  # [m], [m], [rad] at which the rod is looked at last
STARTS = {"at 60 degrees": math.radians(60), "at 75 degrees": math.radians(75)}
RUNGE_KUTTA = 1e-5  # [s]


class Truth(NamedTuple):
    """Angles by the time; where the rod leaves the wall, and how fast."""

    time: np.ndarray  # [s]
    angle: np.ndarray  # [rad]
    leaves: float  # [s]
    speed: float  # of the centre, away from the wall [m/s]


def turning(angle: float, spin: float, on_the_wall: bool) -> float:
    """Return theta'' [rad/s^2]; off the wall the floor's N = m (g + z'') turns it alone."""
    c, s = math.cos(angle), math.sin(angle)
    if on_the_wall:
        return -1.5 * GRAVITY / LENGTH * c
    half = 0.5 * LENGTH
    return -(GRAVITY - half * s * spin**2) * half * c / (LENGTH**2 / 12.0 + (half * c) ** 2)


def truth(start: float) -> Truth:
    """Runge-Kutta's rule of order 4, at a step far shorter than any that is tested."""
    h, angle, spin, t = RUNGE_KUTTA, start, 0.0, 0.0
    times, angles, leaves = [t], [angle], 0.0
    while angle > LAST:
        on_wall = math.sin(angle) > 2.0 / 3.0 * math.sin(start)
        if on_wall:
            leaves = t

        def rate(a: float, w: float, on_wall: bool = on_wall) -> tuple[float, float]:
            return w, turning(a, w, on_wall)

        k1 = rate(angle, spin)
        k2 = rate(angle + 0.5 * h * k1[0], spin + 0.5 * h * k1[1])
        k3 = rate(angle + 0.5 * h * k2[0], spin + 0.5 * h * k2[1])
        k4 = rate(angle + h * k3[0], spin + h * k3[1])
        angle += h / 6.0 * (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0])
        spin += h / 6.0 * (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1])
        t += h
        times.append(t)
        angles.append(angle)
    s = 2.0 / 3.0 * math.sin(start)
    # x = L/2 cos(theta), theta'^2 = 3 g/L (sin(theta_0) - sin(theta))
    speed = 0.5 * LENGTH * s * math.sqrt(3.0 * GRAVITY / LENGTH * (math.sin(start) - s))
    return Truth(np.array(times), np.array(angles), leaves, speed)


def scene(start: float, rate: int, duration: float) -> str:
    """A capsule, its axis from floor to wall, with a rod's moments about its middle."""
    c, s, half = math.cos(start), math.sin(start), 0.5 * (start - 0.5 * math.pi)
    moment = LENGTH**2 / 12.0
    place = (RADIUS + 0.5 * LENGTH * c, 0.0, RADIUS + 0.5 * LENGTH * s)
    bodies = {
        "floor": "{shape: {kind: plane}, surface: one}",
        "wall": "{shape: {kind: plane, normal: [1, 0, 0]}, surface: one}",
        "rod": f"{{shape: {{kind: capsule, radius: {RADIUS}, length: {LENGTH}}}, mass: 1.0, "
        f"inertia: {flow((moment, moment, 1e-3))}, surface: one, position: {flow(place)}, "
        f"orientation: {flow((math.cos(half), 0.0, math.sin(half), 0.0))}}}",
    }
    return config(bodies, rate, duration, surface="friction: 0", gravity=repr(GRAVITY))


def angles(states: States) -> np.ndarray:
    """Return the angle of the rod to the floor; its axis is z of the body."""
    w, x, y, z = states.turn[:, states.names.index("rod")].T
    return np.arctan2(1.0 - 2.0 * (x * x + y * y), -2.0 * (x * z + w * y))


@pytest.fixture(scope="module")
def truths() -> dict[str, Truth]:
    return {name: truth(start) for name, start in STARTS.items()}


@pytest.fixture(scope="module")
def runs(truths: dict[str, Truth]) -> dict[str, dict[int, States]]:
    found: dict[str, dict[int, States]] = {}
    for name, start in STARTS.items():
        steps = {rate: int(truths[name].time[-1] * rate) for rate in RATES}
        texts = {f"{rate}": scene(start, rate, steps[rate] / rate) for rate in RATES}
        found[name] = {int(rate): states for rate, states in run_scenes(texts).items()}
    return found


def off(states: States, true: Truth) -> np.ndarray:
    """Return the errors of the angle [rad]."""
    return np.abs(angles(states) - np.interp(states.time, true.time, true.angle))


@pytest.mark.parametrize("name", STARTS)
@pytest.mark.parametrize("rate", RATES)
def test_a_ladder_slides_down_as_its_equation_of_motion_has_it(
    truths: dict[str, Truth], runs: dict[str, dict[int, States]], name: str, rate: int
) -> None:
    """Of the midpoint rule: dt^2/12 of theta''' over the time, twice for the turn of two normals.

    theta''' = 3 g/(2 L) sin(theta) theta' is at most 3 g/(2 L) times the spin at the end.
    """
    true = truths[name]
    fastest = (true.angle[-2] - true.angle[-1]) / RUNGE_KUTTA
    bound = 1.5 * GRAVITY / LENGTH * fastest * true.time[-1] / (6.0 * rate**2)
    assert off(runs[name][rate], true).max() < bound


@pytest.mark.parametrize("name", STARTS)
def test_the_order_on_the_wall_is_two(
    truths: dict[str, Truth], runs: dict[str, dict[int, States]], name: str
) -> None:
    true = truths[name]
    errors = [off(runs[name][rate], true)[: int(true.leaves * rate)].max() for rate in RATES]
    # Half of what the next order adds at the longest of the steps, which turns by 0.05 rad.
    assert min(orders(errors)) > 1.6
    assert orders(errors)[-1] > 1.8


@pytest.mark.parametrize("name", STARTS)
@pytest.mark.parametrize("rate", RATES)
def test_it_leaves_the_wall_at_two_thirds_of_its_height(
    truths: dict[str, Truth], runs: dict[str, dict[int, States]], name: str, rate: int
) -> None:
    """The wall pushes last in the step of that instant, or in one beside it.

    What it pushes is of second order there: by the force that is left after a step, which grows
    with theta''' (see above), for a step.
    """
    true, states = truths[name], runs[name][rate]
    wall = states.contact[states.contact["body_a"] == states.names.index("wall")]
    last = wall["step"][wall["impulse_n"] > 0.0].max()
    assert abs(last - true.leaves * rate) <= 2.0
    _, velocity, spin = states.of("rod")
    fastest = np.abs(spin[:, 1]).max()
    bound = 1.5 * GRAVITY * fastest / rate**2
    assert abs(velocity[-1, 0] - true.speed) < bound
    # It does not come back.
    assert np.ptp(velocity[last + 2 :, 0]) < bound
