"""Contacts that last are exact where no surface turns, and of second order where one does.

Closed forms of what slides and rolls on a slope, of what a turntable carries, and of a ball that
rolls on it. All scenes are run in one engine.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, run_scenes

RATES = (60, 240, 1000)  # steps a second
HALVED = (120, 240, 480)
# Steps are solved to 1e-9 m/s; where nothing turns a row's rest does not grow with their number.
SOLVED = 1e-9  # [m/s]
BOX, BALL = "{kind: box, size: [0.2, 0.3, 0.1]}", "{kind: sphere, radius: 0.1}"
ROLLER = "{kind: cylinder, radius: 0.1, length: 0.3}"
UPRIGHT, LYING = (1.0, 0.0, 0.0, 0.0), (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
# Orientations in which x is along y, y along z, z along x, so many times.
CYCLES = (UPRIGHT, (0.5, 0.5, 0.5, 0.5), (0.5, -0.5, -0.5, -0.5))
TABLE_RATE, BALL_TABLE_RATE, RADIUS = 4.0, 7.0, 0.5  # [rad/s], [rad/s], [m]


class Slope(NamedTuple):
    """A body released at rest on a slope, and its closed form."""

    shape: str
    height: float  # [m] of the centre
    orientation: tuple[float, ...]
    angle: float  # [degrees]
    friction: float
    acceleration: float  # [m/s^2], downhill
    turning: float  # [rad/s^2], about the horizontal axis to the left of downhill


def slides(angle: float, friction: float) -> float:
    a = math.radians(angle)
    return GRAVITY * (math.sin(a) - friction * math.cos(a))


def rolls(angle: float, inertia: float) -> float:
    """Return the acceleration of what rolls; inertia: over m r^2."""
    return GRAVITY * math.sin(math.radians(angle)) / (1.0 + inertia)


SLOPES = {
    "a box slides": Slope(BOX, 0.05, UPRIGHT, 30, 0.3, slides(30, 0.3), 0),
    "a ball rolls": Slope(BALL, 0.1, UPRIGHT, 20, 0.5, rolls(20, 0.4), rolls(20, 0.4) / 0.1),
    "a cylinder rolls": Slope(ROLLER, 0.1, LYING, 20, 0.5, rolls(20, 0.5), rolls(20, 0.5) / 0.1),
}


def body(shape: str, place: tuple[float, ...], **moving: tuple[float, ...]) -> str:
    """Return a body of 1 kg as a YAML mapping; moving: velocity, angular_velocity, orientation."""
    rest = "".join(f", {key}: {flow(values)}" for key, values in moving.items())
    return f"{{shape: {shape}, mass: 1.0, surface: one, position: {flow(place)}{rest}}}"


def on_slope(slope: Slope, rate: int) -> str:
    """The plane is level and gravity is tilted: downhill is x."""
    bodies = {
        "floor": "{shape: {kind: plane}, surface: one}",
        "body": body(slope.shape, (0, 0, slope.height), orientation=slope.orientation),
    }
    tilted = f"{{tilt_degrees: {slope.angle}}}"
    return config(bodies, rate, 1.0, surface=f"friction: {slope.friction}", gravity=tilted)


def table(rate: float, radius: float) -> str:
    """Return a turntable whose top is z = 0 as a YAML mapping."""
    shape = f"{{kind: cylinder, radius: {radius}, length: 0.1}}"
    return (
        f"{{shape: {shape}, kinematic: true, surface: one, position: [0, 0, -0.05], "
        f"angular_velocity: [0, 0, {rate}]}}"
    )


def carried(margin: float, rate: int) -> str:
    """A block turns with a table, with `margin` of the friction that takes: omega^2 r/g."""
    bodies = {
        "table": table(TABLE_RATE, 1.0),
        "block": body(
            "{kind: box, size: [0.1, 0.1, 0.1]}",
            (RADIUS, 0, 0.05),
            velocity=(0, RADIUS * TABLE_RATE, 0),
            angular_velocity=(0, 0, TABLE_RATE),
        ),
    }
    friction = margin * TABLE_RATE**2 * RADIUS / GRAVITY
    return config(bodies, rate, 1.0, surface=f"friction: {friction!r}", gravity=repr(GRAVITY))


def circling(rate: int, turns: int = 0) -> str:
    """A ball rolls on a turntable at 0.6 m/s: its spin is what makes it roll.

    turns: so many times x becomes y, y becomes z and z becomes x, of all the world.
    """
    start, velocity = np.array([0.3, 0.0, 0.1]), np.array([0.0, 0.6, 0.0])
    up = np.array([0.0, 0.0, 1.0])
    spin = np.cross(up, velocity - BALL_TABLE_RATE * np.cross(up, start)) / 0.1

    def seen(vector: np.ndarray) -> tuple[float, ...]:
        return tuple(np.roll(vector, turns).tolist())

    turned = body(BALL, seen(start), velocity=seen(velocity), angular_velocity=seen(spin))
    below = {"position": -0.05 * up, "angular_velocity": BALL_TABLE_RATE * up}
    lies = "".join(f", {key}: {flow(seen(vector))}" for key, vector in below.items())
    lies += f", orientation: {flow(CYCLES[turns])}"
    shape = "{kind: cylinder, radius: 2.0, length: 0.1}"
    bodies = {
        "table": f"{{shape: {shape}, kinematic: true, surface: one{lies}}}",
        "ball": turned,
    }
    return config(bodies, rate, 3.0, surface="friction: 1", gravity=flow(seen(-GRAVITY * up)))


def thrown(rate: int, beside: bool = False) -> str:
    """A ball is thrown along a floor with spin about all axes; beside: far from what turns."""
    throw = body(BALL, (0, 0, 0.1), velocity=(2, 0, 0), angular_velocity=(30, -20, 50))
    bodies = {"floor": "{shape: {kind: plane}, surface: one}", "ball": throw}
    if beside:
        moving = {"velocity": (0.5, 0, 0), "angular_velocity": (0, 5.0, 0)}
        bodies["roller"] = body(ROLLER, (0, 50, 0.1), orientation=LYING, **moving)
    return config(bodies, rate, 1.0, surface="friction: 0.2", gravity=repr(GRAVITY))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"{name} {rate}": on_slope(SLOPES[name], rate) for name in SLOPES for rate in RATES}
    texts |= {f"{margin} {rate}": carried(margin, rate) for margin in (1.5, 1.01) for rate in RATES}
    texts |= {f"circle {rate}": circling(rate) for rate in HALVED}
    texts |= {f"circle {turns} turns": circling(240, turns) for turns in (1, 2)}
    texts |= {f"thrown beside {rate}": thrown(rate, True) for rate in (60, 240)}
    return run_scenes(texts | {f"thrown {rate}": thrown(rate) for rate in RATES})


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("name", SLOPES)
def test_motion_on_a_slope_is_its_closed_form(ran: dict[str, States], name: str, rate: int) -> None:
    states, slope = ran[f"{name} {rate}"], SLOPES[name]
    place, velocity, spin = states.of("body")
    along, axle = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    t = states.time[:, None]
    fallen = place[0] + slope.acceleration * t**2 / 2.0 * along
    np.testing.assert_allclose(place, fallen, atol=SOLVED)  # for a second
    np.testing.assert_allclose(velocity, slope.acceleration * t * along, atol=SOLVED)
    # A rest of 1e-9 m/s at the surface, 0.1 m from the axis; angular velocities are not its rows.
    np.testing.assert_allclose(spin, slope.turning * t * axle, atol=SOLVED / 0.1)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("margin", [1.5, 1.01])
def test_turntable_carries_a_block_that_friction_can_hold(
    ran: dict[str, States], margin: float, rate: int
) -> None:
    """Its contacts are those of the middle of the step: the chord's force is within the cone."""
    states = ran[f"{margin} {rate}"]
    place = states.place[:, states.names.index("block")]
    turn = states.turn[:, states.names.index("table")]
    angle = 2.0 * np.arctan2(turn[:, 3], turn[:, 0])
    there = RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    # Its rows' rest of 1e-9 m/s for a second, over 2 m: 5e-10 of its displacement at most, were it
    # at every step in one direction; what it is in the direction of the friction adds up.
    np.testing.assert_allclose(place[:, :2], there, atol=1e-6 * RADIUS * TABLE_RATE)
    assert math.hypot(*place[-1, :2]) == pytest.approx(RADIUS, abs=1e-8, rel=0)


def angle_error(states: States) -> float:
    """Return how far [rad] the ball is from where it should be on its circle, in the end."""
    x, y = (states.of("ball")[1][-1, :2] / 0.6).tolist()
    return abs(math.remainder(math.atan2(-x, y) - 2.0 / 7.0 * BALL_TABLE_RATE * 3.0, math.tau))


def test_ball_on_a_turntable_circles_at_two_sevenths_of_its_rate_to_order_2(
    ran: dict[str, States],
) -> None:
    """v' = (2/7) Omega z x v, of which contacts at the middle of the step make Cayley's map:
    2 atan(k dt/2) a step instead of k dt, late by (k dt)^2/12 of it.
    """
    k = 2.0 / 7.0 * BALL_TABLE_RATE
    errors = [angle_error(ran[f"circle {rate}"]) for rate in HALVED]
    for rate, error in zip(HALVED, errors, strict=True):
        late = 3.0 * rate * (k / rate - 2.0 * math.atan(k / rate / 2.0))
        # Rests of 1e-9 m/s at 0.6 m/s, were they at each of 1440 steps in one direction.
        assert error == pytest.approx(late, abs=1440 * SOLVED / 0.6, rel=0)
    # The same rests in the finest error of 8.7e-6 rad: log2(1 + 2.4e-6/8.7e-6) = 0.35.
    for coarse, fine in itertools.pairwise(errors):
        assert math.log2(coarse / fine) == pytest.approx(2.0, abs=0.35)


@pytest.mark.parametrize("turns", [1, 2])
def test_ball_on_a_turntable_circles_alike_whichever_way_is_up(
    ran: dict[str, States], turns: int
) -> None:
    """Bodies stand at the middle of the step by each of their coordinates, and by its sign.

    Rests of 1e-9 m/s at each of 720 steps, in one direction, and where they lead for 3 s.
    """
    level, turned = ran["circle 240"].of("ball"), ran[f"circle {turns} turns"].of("ball")
    for plain, seen, length in zip(level, turned, (3.0, 1.0, 1.0 / 0.1), strict=True):
        known = 720 * SOLVED * length
        np.testing.assert_allclose(np.roll(seen, -turns, axis=1), plain, atol=known)


@pytest.mark.parametrize("rate", HALVED)
def test_ball_on_a_turntable_stays_on_its_circle(ran: dict[str, States], rate: int) -> None:
    """Cayley's map is a rotation: whatever the timestep, the circle closes."""
    place, velocity, _ = ran[f"circle {rate}"].of("ball")
    k = 2.0 / 7.0 * BALL_TABLE_RATE
    # Chords of 2 atan(k dt/2) and length 0.6 dt are those of a circle of radius v/k exactly.
    centre = np.array([0.3 - 0.6 / k, 0.0])
    off = np.linalg.norm(place[:, :2] - centre, axis=1) - 0.6 / k
    np.testing.assert_allclose(off, 0.0, atol=3 * rate * SOLVED)  # rests over 3 s
    np.testing.assert_allclose(np.linalg.norm(velocity, axis=1), 0.6, atol=3 * rate * SOLVED)


@pytest.mark.parametrize("rate", RATES)
def test_ball_with_side_spin_slides_on_a_parabola_and_rolls_on_a_line(
    ran: dict[str, States], rate: int
) -> None:
    """The slip keeps its direction while it falls by 7/2 mu g; friction is against it."""
    states = ran[f"thrown {rate}"]
    place, velocity, spin = states.of("ball")
    slip = velocity[0] + np.cross(spin[0], [0, 0, -0.1])
    speed = math.hypot(*slip[:2])
    push = -0.2 * GRAVITY * slip / speed
    rolling = 2.0 * speed / (7.0 * 0.2 * GRAVITY)  # from then on [s]
    assert rolling < 0.8
    sliding = states.time <= rolling
    t = states.time[sliding][:, None]
    exact = place[0] + velocity[0] * t + push * t**2 / 2.0
    np.testing.assert_allclose(place[sliding], exact, atol=SOLVED)
    np.testing.assert_allclose(velocity[sliding], velocity[0] + push * t, atol=SOLVED)
    final = velocity[0] + push * rolling
    np.testing.assert_allclose(velocity[-1], final, atol=SOLVED)
    assert spin[-1, 2] == pytest.approx(50.0, abs=SOLVED / 0.1)  # nothing brakes it
    # The step in which the slip ends is one of mean velocities: off by less than mu g dt^2.
    line = place[0] + velocity[0] * rolling + push * rolling**2 / 2.0 + final * (1.0 - rolling)
    np.testing.assert_allclose(place[-1], line, atol=0.2 * GRAVITY / rate**2)


@pytest.mark.parametrize("rate", [60, 240])
def test_ball_on_a_plane_has_at_the_middle_what_it_has_at_the_start(
    ran: dict[str, States], rate: int
) -> None:
    """All of a step is solved at its middle, too, where a cylinder turns: 50 m away.

    Round-off of 2^-53 of 2 m/s and 60 rad/s, at each of 240 steps in one direction, is 1e-13 of it.
    """
    alone, beside = ran[f"thrown {rate}"].of("ball"), ran[f"thrown beside {rate}"].of("ball")
    for one, other, size in zip(alone, beside, (2.0, 2.0, 60.0), strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-13 * size)
