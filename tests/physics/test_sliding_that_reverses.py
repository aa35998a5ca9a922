"""Sliding that stops within a step, and what follows it: rest, rolling, or sliding back.

Constant forces are integrated to what steps are solved to; forces that vary at second order. All
truths are closed forms, joined where the slip vanishes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, orders, run_scenes

RATES = (60, 240, 1000)  # steps a second
# Steps are solved to 1e-9 m/s each, and what slides keeps none of a step's rest in the next.
SOLVED = 1e-9  # [m/s]; [m] of ways, which take a second
BOX, BALL = "{kind: box, size: [0.2, 0.3, 0.1]}", "{kind: sphere, radius: 0.1}"
RADIUS = 0.1  # [m]


class Phase(NamedTuple):
    """Motion along x under a constant acceleration, from `begin` [s] on."""

    begin: float
    x: float
    v: float
    a: float

    def at(self, t: float) -> tuple[float, float]:
        """Return place and velocity."""
        t -= self.begin
        return self.x + self.v * t + 0.5 * self.a * t**2, self.v + self.a * t

    def then(self, t: float, a: float, rests: bool = False) -> Phase:
        x, v = self.at(t)
        return Phase(t, x, 0.0 if rests else v, a)


class Scene(NamedTuple):
    """A scene whose body called `body` moves along x in phases."""

    bodies: dict[str, str]
    surface: str
    gravity: str
    phases: list[Phase]

    def text(self, rate: int) -> str:
        return config(self.bodies, rate, 0.6, self.surface, self.gravity)

    def at(self, t: float) -> tuple[float, float]:
        return [phase for phase in self.phases if phase.begin <= t][-1].at(t)


def body(shape: str, height: float, v: float, y: float = 0.0, spin: float = 0.0) -> str:
    """Return a body of 1 kg; v: along x [m/s]; spin: about y [rad/s]."""
    return (
        f"{{shape: {shape}, mass: 1.0, surface: one, position: {flow((0, y, height))}, "
        f"velocity: {flow((v, 0, 0))}, angular_velocity: {flow((0, spin, 0))}}}"
    )


PLANE = "{shape: {kind: plane}, surface: one}"


def pulls(degrees: float) -> tuple[float, float]:
    """Return gravity along a slope, downhill, and across it [m/s^2]."""
    angle = math.radians(degrees)
    return GRAVITY * math.sin(angle), GRAVITY * math.cos(angle)


def box_up_a_slope(v: float, degrees: float, mu: float) -> Scene:
    """Downhill is x; the box is pushed uphill, and slides back where friction cannot hold it."""
    along, across = pulls(degrees)
    up, holds = Phase(0.0, 0.0, -v, along + mu * across), mu * across >= along
    back = up.then(v / up.a, 0.0 if holds else along - mu * across, rests=True)
    bodies = {"floor": PLANE, "body": body(BOX, 0.05, -v)}
    return Scene(bodies, f"friction: {mu}", f"{{tilt_degrees: {degrees}}}", [up, back])


def ball_up_a_slope(v: float, degrees: float, mu: float) -> Scene:
    """It slides uphill, its slip reverses before it does, and it slides on downhill.

    mu < 2/7 tan(angle): friction cannot make it roll.
    """
    along, across = pulls(degrees)
    first = Phase(0.0, 0.0, -v, along + mu * across)
    # slip v - R w: friction slows v by mu g', and w grows by 5/2 mu g'/R
    second = first.then(v / (along + 3.5 * mu * across), along - mu * across)
    bodies = {"floor": PLANE, "body": body(BALL, RADIUS, -v)}
    return Scene(bodies, f"friction: {mu}", f"{{tilt_degrees: {degrees}}}", [first, second])


def ball_begins_to_roll(v: float, mu: float) -> Scene:
    """The slip v - R w vanishes at v = 5/7 of what it was. Beside it another goes the same way.

    One ball on a level plane slides on in steps of one part: where it begins to roll is at order 2.
    """
    first = Phase(0.0, 0.0, v, -mu * GRAVITY)
    bodies = {"floor": PLANE, "body": body(BALL, RADIUS, v), "other": body(BALL, RADIUS, v, 2.0)}
    second = first.then(v / (3.5 * mu * GRAVITY), 0.0)
    return Scene(bodies, f"friction: {mu}", repr(GRAVITY), [first, second])


def ball_rolls_against_its_resistance(v: float, degrees: float, resistance: float) -> Scene:
    """It rolls uphill and back; `rolling_friction` [m] is against its spin, whichever way."""
    along, across = pulls(degrees)
    spent = resistance / RADIUS * across
    up = Phase(0.0, 0.0, -v, (along + spent) / 1.4)
    back = up.then(v / up.a, (along - spent) / 1.4, rests=True)
    spin = -v / RADIUS
    bodies = {
        "floor": PLANE,
        "body": body(BALL, RADIUS, -v, 0.0, spin),
        "other": body(BALL, RADIUS, -v, 2.0, spin),
    }
    surface = f"friction: 0.6, rolling_friction: {resistance}"
    return Scene(bodies, surface, f"{{tilt_degrees: {degrees}}}", [up, back])


def box_on_a_belt(v: float, belt: float, mu: float) -> Scene:
    """Laid on a belt against its motion it is taken along, turns round, and rides."""
    first = Phase(0.0, 0.0, v, mu * GRAVITY)
    bodies = {
        "belt": "{shape: {kind: box, size: [10, 1, 1]}, fixed: true, position: [0, 0, -0.5], "
        f"surface_velocity: [{belt}, 0, 0], surface: one}}",
        "body": body(BOX, 0.05, v),
    }
    second = first.then((belt - v) / first.a, 0.0)
    return Scene(bodies, f"friction: {mu}", repr(GRAVITY), [first, second])


def box_on_a_sledge(v: float, mu: float) -> Scene:
    """Two bodies that stop on each other: the sledge of 3 kg has no friction with the floor."""
    slip, total = Phase(0.0, 0.0, v, -mu * GRAVITY), mu * GRAVITY * (1.0 + 1.0 / 3.0)
    bodies = {
        "floor": "{shape: {kind: plane}, surface: {friction: 0}}",
        "sledge": "{shape: {kind: box, size: [4, 1, 0.2]}, mass: 3.0, surface: one, "
        "position: [0, 0, 0.1]}",
        "body": body(BOX, 0.25, v),
    }
    return Scene(bodies, f"friction: {mu}", repr(GRAVITY), [slip, slip.then(v / total, 0.0)])


SCENES = {
    "a box slides back": box_up_a_slope(1.0, 30, 0.3),
    "it stays": box_up_a_slope(1.3, 20, 0.5),
    "it slides back on what is all but smooth": box_up_a_slope(0.77, 30, 0.05),
    "the slip of a ball reverses": ball_up_a_slope(1.0, 30, 0.1),
    "a ball begins to roll": ball_begins_to_roll(1.0, 0.2),
    "a ball rolls back": ball_rolls_against_its_resistance(0.8, 10, 0.01),
    "a box on a belt turns round": box_on_a_belt(-0.3, 1.0, 0.4),
    "a box stops on a sledge": box_on_a_sledge(0.9, 0.35),
}


@pytest.fixture(scope="module")
def runs() -> dict[str, States]:
    found = {}
    for name, scene in SCENES.items():
        texts = {f"{name}, 1/{rate}": scene.text(rate) for rate in RATES}
        found.update(run_scenes(texts))
    return found


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("name", SCENES)
def test_constant_forces_are_integrated_up_to_a_stop_and_on_from_it(
    runs: dict[str, States], name: str, rate: int
) -> None:
    states = runs[f"{name}, 1/{rate}"]
    place, velocity, _ = states.of("body")
    truth = np.array([SCENES[name].at(t) for t in states.time])
    assert np.abs(place[:, 0] - truth[:, 0]).max() < SOLVED
    assert np.abs(velocity[:, 0] - truth[:, 1]).max() < SOLVED
    assert states.step["parts"].sum() == len(states.step)  # one of them in two


# Under a force F sin(w t) along x, m = 1 kg: it slips where that is more than mu g.
FORCE, TURNING, GRIP = 7.0, 9.0, 0.3 * GRAVITY  # [N], [rad/s], [m/s^2]
HALVED = (60, 120, 240, 480)


def under_a_sine(rate: int) -> str:
    text = config(
        {"floor": PLANE, "body": body(BOX, 0.05, 0.0)}, rate, 1.5, "friction: 0.3", "9.81"
    )
    force = f"factor: {{kind: sine, frequency: {TURNING / (2.0 * math.pi)!r}}}"
    return text.replace(
        "numerics:", f"  forces:\n    - {{body: body, force: [{FORCE}, 0, 0], {force}}}\nnumerics:"
    )


def bisect(f: Callable[[float], float], low: float, high: float) -> float:
    """Return where f changes its sign."""
    rises = f(high) > f(low)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if (f(middle) > 0.0) == rises else (middle, high)
    return 0.5 * (low + high)


def first_zero(
    motion: Callable[[float], tuple[float, float]], times: np.ndarray, sign: float
) -> float:
    """Return when a velocity of that sign at first vanishes; at the latest the last of times."""
    after = np.flatnonzero([sign * motion(one)[1] <= 0.0 for one in times])
    if not len(after):
        return float(times[-1])
    k = int(after[0])
    return bisect(lambda one: motion(one)[1], times[max(k - 1, 0)], times[k])


def slides_under_a_sine(end: float) -> Iterator[tuple[float, float, float, float]]:
    """Yield the slides up to `end`: begin [s], stop [s], place at the begin [m], sign.

    v' = F sin(w t) - sign mu g from where the force overcomes friction, or from where the slip
    vanished while it does, up to where v vanishes.
    """
    t, x = 0.0, 0.0
    while t < end:
        phase = math.asin(GRIP / FORCE)
        force = FORCE * math.sin(TURNING * t)
        if abs(force) <= GRIP:
            half = math.pi / TURNING
            begin = next(
                one for one in (phase / TURNING + k * half for k in range(99)) if one >= t - 1e-12
            )
        else:
            begin = t
        sign = math.copysign(1.0, math.sin(TURNING * (begin + 1e-6)))
        stop = first_zero(slide(begin, 0.0, sign), begin + np.linspace(1e-4, 2.0, 20_000), sign)
        yield begin, stop, x, sign
        x, t = slide(begin, x, sign)(stop)[0], stop


def slide(begin: float, x: float, sign: float) -> Callable[[float], tuple[float, float]]:
    """Return place and velocity of a slide that begins at rest, by the time."""

    def at(t: float) -> tuple[float, float]:
        s, c = FORCE / TURNING * math.cos(TURNING * begin), FORCE / TURNING
        v = s - c * math.cos(TURNING * t) - sign * GRIP * (t - begin)
        way = s * (t - begin) - sign * 0.5 * GRIP * (t - begin) ** 2
        way -= c / TURNING * (math.sin(TURNING * t) - math.sin(TURNING * begin))
        return x + way, v

    return at


def test_stops_under_a_force_that_varies_are_at_second_order() -> None:
    """Of six slides to and fro, which stop at any part of a step."""
    slides = list(slides_under_a_sine(1.5))
    assert len(slides) >= 4
    errors = []
    for rate in HALVED:
        states = run_scenes({f"sine, 1/{rate}": under_a_sine(rate)})[f"sine, 1/{rate}"]
        place, _, _ = states.of("body")
        worst = 0.0
        for k, t in enumerate(states.time):
            begin, stop, x, sign = [one for one in slides if one[0] <= t or one is slides[0]][-1]
            truth = slide(begin, x, sign)(min(max(t, begin), stop))[0]
            worst = max(worst, abs(place[k, 0] - truth))
        errors.append(worst)
    # The order from the first to the last: single stops fall on any phase of their steps.
    assert sum(orders(errors)) / len(orders(errors)) > 1.8
