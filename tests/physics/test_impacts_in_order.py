"""Impacts of frictionless balls with each other happen one after the other within a step.

Closed forms of rows and the conservation laws of a gas, at every timestep: none is part of the law.
All scenes are run in one engine.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, plane, run_scenes

RATES = (60, 240, 1000)  # steps a second
GAPS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # [m]
SPEEDS = (1, 5, 100)  # [m/s]
# Where bodies touch is found to 1e-9 m (`SAME_PLACE` of the engine: what is closer meets at once).
PLACE = 1e-9  # [m]
# An impact is solved to the default tolerance of a step.
IMPACT = 1e-9  # [m/s]
ALIKE = 0.05  # [m], radius


class Cluster(NamedTuple):
    """Balls on a line."""

    mass: tuple[float, ...] = (1.0, 2.0, 0.5, 3.0, 1.0, 0.2)
    radius: tuple[float, ...] = (0.05, 0.06, 0.04, 0.07, 0.05, 0.03)
    place: tuple[float, ...] = (0.0, 0.12, 0.2205, 0.330502, 0.500502, 0.583502)
    velocity: tuple[float, ...] = (1.7, 0.0, 0.0, -0.3, 0.0, 0.0)

    def after(self, seconds: float, e: float) -> np.ndarray:
        """Return their velocities, from one impact of two to the next [m/s]."""
        x, v = np.array(self.place), np.array(self.velocity)
        m, touch = np.array(self.mass), np.add(self.radius[1:], self.radius[:-1])
        while True:
            gaps, rates = np.diff(x) - touch, np.diff(v)
            speeds = np.maximum(-rates, 1e-12)  # slower ones are round-off
            due = np.where(speeds > 1e-12, np.maximum(gaps, 0.0) / speeds, np.inf)
            first = int(np.argmin(due))
            if due[first] > seconds:
                return v
            seconds -= due[first]
            x += due[first] * v
            push = -(1.0 + e) * rates[first] / (1.0 / m[first] + 1.0 / m[first + 1])
            v[first] -= push / m[first]
            v[first + 1] += push / m[first + 1]


CLUSTER = Cluster()


def cradle(gap: float, rate: int) -> str:
    """Two balls in a row strike five at rest, `gap` apart, from 50 mm and a part of a step."""
    pitch, lead = 2.0 * ALIKE + gap, 0.05 + 0.4 / rate
    x = [-pitch - lead - 2.0 * ALIKE, -lead - 2.0 * ALIKE, *(k * pitch for k in range(5))]
    bodies = {
        f"b{k}": ball(ALIKE, 1.0, (at, 0, 0), (1.0 if k < 2 else 0.0, 0, 0))
        for k, at in enumerate(x)
    }
    # The last impact is over when the second ball has come lead + 6 gaps, at 1 m/s.
    return config(bodies, rate, math.ceil((lead + 8.0 * gap) * rate + 1) / rate)


def tower(rate: int) -> tuple[str, float]:
    """A ball of 1 kg above one of 3 kg, dropped together; with the height its centre rises to."""
    drop, gap, low, high = 0.83, 0.005, 0.1, 0.06
    v = math.sqrt(2.0 * GRAVITY * drop)  # of both when the lower one meets the floor
    meet = gap / (2.0 * v)  # later the gap is closed: both fall alike
    at = low + v * meet - GRAVITY * meet**2 / 2.0
    down, up = -v - GRAVITY * meet, v - GRAVITY * meet
    rebound = down + 2.0 * 3.0 / (3.0 + 1.0) * (up - down)
    bodies = {
        "floor": plane(),
        "lower": ball(low, 3.0, (0, 0, drop + low)),
        "upper": ball(high, 1.0, (0, 0, drop + 2.0 * low + gap + high)),
    }
    seconds = math.ceil((v / GRAVITY + meet + 0.1) * rate) / rate
    return config(bodies, rate, seconds, gravity=repr(GRAVITY)), (
        at + low + high + rebound**2 / (2.0 * GRAVITY)
    )


def row(rate: int) -> str:
    """Thirty balls 0.5 mm apart, each with 0.9 of the mass of the one before."""
    pitch, lead = 2.0 * ALIKE + 0.0005, 0.02 + 0.3 / rate
    bodies = {
        f"b{k}": ball(ALIKE, 0.9**k, (k * pitch - (0 if k else lead), 0, 0), (0 if k else 1, 0, 0))
        for k in range(30)
    }
    return config(bodies, rate, math.ceil((lead + 30 * 0.0005) * rate + 1) / rate)


def clusters(rate: int) -> str:
    """Six balls in a row, e = 0.3: three of them come to rest by each other before they are hit.

    Theirs are ever smaller gaps, 20 and 40 nm as the first ball meets them, and no contact.
    """
    rows = zip(CLUSTER.place, CLUSTER.velocity, CLUSTER.mass, CLUSTER.radius, strict=True)
    bodies = {f"b{k}": ball(r, m, (x, 0, 0), (v, 0, 0)) for k, (x, v, m, r) in enumerate(rows)}
    return config(bodies, rate, 0.5, surface="restitution: 0.3")


def misses(speed: int, rate: int) -> str:
    """Eight balls pass others at 0.1 mm, each released an eighth of a step's displacement later."""
    step = speed / rate
    lead, pitch = max(0.12, 3.0 * step), 1.0 + 3.0 * step
    bodies = {}
    for phase in range(8):
        y = pitch * phase
        start = (-lead - step * phase / 8.0, y + 2.0 * ALIKE + 1e-4, 0)
        bodies[f"passing{phase}"] = ball(ALIKE, 1.0, start, (speed, 0, 0))
        bodies[f"at_rest{phase}"] = ball(ALIKE, 1.0, (0, y, 0))
    steps = math.ceil(2.0 * lead / step) + 3
    return config(bodies, rate, steps / rate, surface="restitution: 0.5")


def gas(rate: int) -> str:
    """Fifty balls in a box of 1 m, all at 1 m/s, for a second: some five impacts each."""
    random = np.random.default_rng(3)
    places = list(itertools.product((-0.36, -0.12, 0.12, 0.36), repeat=3))
    bodies = {}
    for k in range(3):
        bodies |= {f"low{k}": plane(np.eye(3)[k], -0.5), f"high{k}": plane(-np.eye(3)[k], -0.5)}
    for k, at in enumerate(random.permutation(len(places))[:50]):
        v = random.normal(size=3)
        start = np.array(places[at]) + random.uniform(-0.06, 0.06, 3)
        bodies[f"b{k}"] = ball(ALIKE, 1.0, start, tuple(v / np.linalg.norm(v)))
    return config(bodies, rate, 1.0)


def rack(rate: int) -> str:
    """Fifteen balls that rest on a table, 10 um apart, broken by one at 8 m/s."""
    pitch = 2.0 * ALIKE + 1e-5
    bodies = {"floor": plane()}
    for row in range(5):
        for k in range(row + 1):
            place = (row * pitch * math.sqrt(0.75), (k - 0.5 * row) * pitch, ALIKE)
            bodies[f"b{row}{k}"] = ball(ALIKE, 1.0, place)
    bodies["cue"] = ball(ALIKE, 1.0, (-0.3, 0.003, ALIKE), (8, 0, 0))
    return config(bodies, rate, 6.0 / 60.0, gravity=repr(GRAVITY))


def to_and_fro(mass: float, rate: int) -> str:
    """A ball between a wall and one of so many times its mass, which comes at 1 m/s."""
    bodies = {
        "wall": plane((1, 0, 0)),
        "small": ball(ALIKE, 1.0, (0.3, 0, 0)),
        "large": ball(ALIKE, mass, (0.6, 0, 0), (-1, 0, 0)),
    }
    # Nearest at 0.45 s, and then away as it came: the last impact of all is a slow one, by 1.4 s.
    return config(bodies, rate, 1.5)


TOWERS = {rate: tower(rate) for rate in RATES}


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {f"cradle {gap:g} {rate}": cradle(gap, rate) for gap in GAPS for rate in RATES}
    texts |= {f"misses {speed} {rate}": misses(speed, rate) for speed in SPEEDS for rate in RATES}
    texts |= {f"tower {rate}": text for rate, (text, _) in TOWERS.items()}
    texts |= {f"row {rate}": row(rate) for rate in RATES}
    texts |= {f"clusters {rate}": clusters(rate) for rate in RATES}
    texts |= {f"gas {rate}": gas(rate) for rate in RATES}
    texts |= {f"rack {rate}": rack(rate) for rate in RATES}
    texts |= {f"to and fro {rate}": to_and_fro(1e6, rate) for rate in RATES}
    texts |= {f"to and fro for long {rate}": to_and_fro(1e8, rate) for rate in RATES}
    return run_scenes(texts)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("gap", GAPS)
def test_of_seven_balls_with_gaps_two_strike_and_two_leave(
    ran: dict[str, States], gap: float, rate: int
) -> None:
    """An impact of equal masses at e = 1 swaps velocities."""
    # Ten impacts, each hands on the errors of those before it.
    got = ran[f"cradle {gap:g} {rate}"].velocity[-1, :, 0]
    np.testing.assert_allclose(got, [0, 0, 0, 0, 0, 1, 1], atol=10 * IMPACT)


@pytest.mark.parametrize("rate", RATES)
def test_ball_on_a_heavier_ball_rises_as_two_impacts_in_order_have_it(
    ran: dict[str, States], rate: int
) -> None:
    place, velocity, _ = ran[f"tower {rate}"].of("upper")
    assert velocity[-1, 2] > 0
    # In free flight, so its apex is known. An impact off by d is early or late by d/v: what the
    # balls approach by, 2 v, is off by 2 g d/v; so are velocities, and the height by v/g of them,
    # in all less than 10 d.
    apex = place[-1, 2] + velocity[-1, 2] ** 2 / (2.0 * GRAVITY)
    assert apex == pytest.approx(TOWERS[rate][1], abs=10 * PLACE, rel=0)


@pytest.mark.parametrize("rate", RATES)
def test_ball_between_a_wall_and_one_of_a_million_masses_counts_the_digits_of_pi(
    ran: dict[str, States], rate: int
) -> None:
    """3,141 impacts (Galperin 2003), up to 3,000 of them in one step.

    With m = 1, M = 1e6, tan(a) = sqrt(m/M): from one impact of the two balls to the next the vector
    (sqrt(M) V, sqrt(m) v) turns by 2 a, the wall turns v round; after the 1,571st they part.
    """
    states, ratio = ran[f"to and fro {rate}"], 1e6
    assert not states.step["unordered"].any()
    turned = 2.0 * 1571 * math.atan(1.0 / math.sqrt(ratio))
    expected = [-math.sqrt(ratio) * math.sin(turned), -math.cos(turned)]
    got = states.velocity[-1, [states.names.index(name) for name in ("small", "large")], 0]
    # Each impact adds some two roundings of up to 1,000 m/s, and the errors of a rotation add up.
    np.testing.assert_allclose(got, expected, atol=2 * 3141 * 1000.0 * 2.0**-52, rtol=0)


@pytest.mark.parametrize("rate", RATES)
def test_impacts_beyond_all_count_end_without_rebound_and_win_no_energy(
    ran: dict[str, States], rate: int
) -> None:
    """31,415 of them, by the same law: the step that has spent its rows is plastic from there."""
    states = ran[f"to and fro for long {rate}"]
    assert states.step["unordered"].sum() == 1
    energy = states.energy()
    # Of 4,370 impacts each is solved to round-off of 10,000 m/s, with 1 kg: 5e7 J, 2^-52 of it.
    assert np.diff(energy).max() < 4370 * 5e7 * 2.0**-52
    # What comes on without rebound stops at the wall: none of it goes through.
    assert states.of("small")[0][:, 0].min() > ALIKE - 1e-6


@pytest.mark.parametrize("rate", RATES)
def test_row_of_ever_lighter_balls_hands_on_its_speed(ran: dict[str, States], rate: int) -> None:
    """A ball of 0.9 of the mass leaves with 2/1.9 of the velocity, the other keeps 0.1/1.9."""
    passed = (2.0 / 1.9) ** np.arange(30)
    expected = np.append(passed[:-1] * 0.1 / 1.9, passed[-1])  # the last: 4.427 m/s
    got = ran[f"row {rate}"].velocity[-1, :, 0]
    # 29 impacts, whose errors grow with the velocity that is handed on.
    np.testing.assert_allclose(got, expected, atol=29 * passed[-1] * IMPACT)


@pytest.mark.parametrize("rate", RATES)
def test_balls_that_fly_between_rebounds_are_none_that_rest_by_each_other(
    ran: dict[str, States], rate: int
) -> None:
    """Across gaps below the slop: what approaches to meet after the part has not met in it."""
    got = ran[f"clusters {rate}"].velocity[-1, :, 0]
    # What is slower than 1e-7 m/s comes to rest: each of some 60 impacts is without one so slow.
    np.testing.assert_allclose(got, CLUSTER.after(0.5, 0.3), atol=1e-6)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("speed", SPEEDS)
def test_a_near_miss_is_a_miss_to_the_bit(ran: dict[str, States], speed: int, rate: int) -> None:
    states = ran[f"misses {speed} {rate}"]
    assert np.all(states.place[-1, ::2, 0] > 2.0 * ALIKE), "some have not passed"
    np.testing.assert_array_equal(states.velocity[-1], states.velocity[0])
    np.testing.assert_array_equal(states.place[-1, 1::2], states.place[0, 1::2])


@pytest.mark.parametrize("rate", RATES)
def test_gas_keeps_its_energy_and_only_walls_change_its_momentum(
    ran: dict[str, States], rate: int
) -> None:
    states = ran[f"gas {rate}"]
    assert not states.step["unordered"].any()
    # 25 J in some 300 impacts: each is one row, solved to round-off of 2 m/s: 300 * 4e-16 J. Where
    # three meet within 1e-9 m the tolerance counts: 2 J s/m * 1e-9 m/s.
    np.testing.assert_allclose(states.energy(), 25.0, rtol=1e-9)
    walls = [states.names.index(name) for name in states.names if name[0] != "b"]
    balls = states.place[:, len(walls) :]
    assert abs(balls).max() <= 0.5 - ALIKE + PLACE
    rows = states.contact
    first, other = np.isin(rows["body_a"], walls), np.isin(rows["body_b"], walls)
    # The normal points from A to B and the impulse is on B.
    sign = (first.astype(float) - other) * rows["impulse_n"]
    pushed = np.zeros((rate + 1, 3))
    np.add.at(pushed, rows["step"], np.stack([rows[f"n{c}"] for c in "xyz"], -1) * sign[:, None])
    momentum = states.velocity.sum(axis=1)
    # Of 50 kg m/s: every impulse is added to two velocities, each rounded by 1e-16 m/s.
    np.testing.assert_allclose(np.diff(momentum, axis=0), pushed[1:], atol=50 * 1e-12)


@pytest.mark.parametrize("rate", RATES)
def test_break_of_balls_that_rest_on_a_table_keeps_its_energy(
    ran: dict[str, States], rate: int
) -> None:
    """Each part of the step has the rows of all that rests, and all impacts are still in order."""
    states = ran[f"rack {rate}"]
    assert not states.step["unordered"].any()
    balls = [states.names.index(name) for name in states.names if name != "floor"]
    assert np.sum(np.abs(states.velocity[-1, balls]).max(axis=1) > 0.1) > 5, "no break"
    # Some forty impacts, each off by its row's rest, and rows of the table that hold the balls to
    # theirs: 1e-9 m/s at 16 m/s, of 32 J.
    energy = states.energy()
    np.testing.assert_allclose(energy - energy[0], 0.0, atol=32.0 * 40 * IMPACT)
