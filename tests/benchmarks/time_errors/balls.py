"""Rows of frictionless balls: impacts in their order, against twins and conservation laws."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np

from tests.oracle.balls_on_a_line import Line

from .impacts import ELASTIC, WORLDS, energy_off, walls
from .row import Row, Scenes
from .scene import (
    GRAVITY,
    LEVEL,
    TURNED,
    UP,
    States,
    World,
    plane,
    sphere,
)


def line_scene(
    world: World, line: Line, place: np.ndarray, velocity: np.ndarray, rate: int, seconds: float
) -> tuple[str, object]:
    """Return balls on a line along the world's z, and how far off the twin they end [m, m/s]."""
    bodies = {"floor": world.floor()} if line.floor else {}
    for k, (mass, radius) in enumerate(zip(line.masses, line.radii, strict=True)):
        start = (0, 0, float(place[k]))
        bodies[f"b{k}"] = world.body(
            sphere(float(radius)), start, velocity[k] * UP, mass=float(mass)
        )
    gravity = (0, 0, -line.gravity)
    text = world.config(bodies, rate, seconds, f"restitution: {line.restitution!r}", gravity)

    def error(states: States) -> float:
        x, v = line.after(float(states.time[-1]), place, velocity)
        worst = 0.0
        for k in range(len(x)):
            at, fast, _ = states.of(f"b{k}")
            worst = max(worst, np.abs(world.level(at[-1]) - x[k] * UP).max())
            worst = max(worst, np.abs(world.level(fast[-1]) - v[k] * UP).max())
        return float(worst)

    return text, error


def row_of(
    masses: Sequence[float], radius: float, gaps: Sequence[float], lead: float, hit: int
) -> tuple[Line, np.ndarray, np.ndarray]:
    """Return a row, its places and velocities: the first `hit` balls at 1 m/s, `lead` away."""
    count = len(masses)
    apart = np.array([2.0 * radius + gap for gap in gaps])
    apart[hit - 1] += lead
    if hit > 1:
        apart[: hit - 1] = 2.0 * radius + 1e-3
    place = np.concatenate([[0.0], np.cumsum(apart)])
    velocity = np.where(np.arange(count) < hit, 1.0, 0.0)
    return Line(np.array(masses, dtype=float), np.full(count, radius)), place, velocity


def cradles(rate: int, energy: bool = False) -> Scenes:
    found = {}
    for gap in (1e-6, 1e-5, 1e-4, 1e-2):
        for hit, masses in (
            (2, [1.0] * 7),
            (3, [0.4] * 7),
            (1, [1.0, 1.7, 1.0, 0.6, 1.0, 2.0, 1.0]),
        ):
            gaps = [gap * (1.0 + 0.1 * k) for k in range(6)]
            line, place, velocity = row_of(masses, 0.05, gaps, 0.05 + 0.4 / rate, hit)
            world = TURNED if hit == 3 else LEVEL
            text, error = line_scene(world, line, place, velocity, rate, 0.25)
            found[f"gap {gap:g} m, {hit} strike"] = text, energy_off if energy else error
    return found


def cradles_energy(rate: int) -> Scenes:
    return cradles(rate, energy=True)


def towers(rate: int) -> Scenes:
    """Balls above each other that are dropped: masses, radii, gaps, restitution."""
    found = {}
    for masses, radii, gap, restitution, drop in (
        ((3.0, 1.0), (0.1, 0.06), 0.005, 1.0, 0.83),
        ((1.0, 1.0), (0.05, 0.05), 0.005, 1.0, 0.5),
        ((10.0, 1.0), (0.15, 0.05), 1e-4, 1.0, 1.0),
        ((9.0, 3.0, 1.0), (0.1, 0.07, 0.05), 0.003, 1.0, 0.6),
        ((5.0, 1.0), (0.1, 0.06), 0.005, 0.8, 0.83),
    ):
        line = Line(np.array(masses), np.array(radii), restitution, GRAVITY, True)
        heights, at = [], drop
        for radius in radii:
            heights.append(at + radius)
            at += 2.0 * radius + gap
        place, velocity = np.array(heights), np.zeros(len(masses))
        fall = math.sqrt(2.0 * drop / GRAVITY)
        for name, world in WORLDS.items():
            found[f"{masses}, e = {restitution}{name}"] = line_scene(
                world, line, place, velocity, rate, 1.4 * fall
            )
    return found


def falling_masses(rate: int) -> Scenes:
    found = {}
    for share, gap, count in ((0.9, 5e-4, 30), (0.8, 1e-5, 12), (1.2, 2e-3, 20)):
        masses = [share**k for k in range(count)]
        line, place, velocity = row_of(masses, 0.05, [gap] * (count - 1), 0.02 + 0.3 / rate, 1)
        seconds = 0.1 + 2.0 * gap * count
        found[f"{count} balls of {share}"] = line_scene(LEVEL, line, place, velocity, rate, seconds)
    return found


def gas(count: int, seconds: float, kind: str, seeds: Sequence[int] = (3,)):
    """Balls in a box of 1 m, all at 1 m/s: energy, momentum, or the test of their speeds."""

    def scenes(rate: int) -> Scenes:
        return {
            f"seed {seed}": (gas_text(count, seconds, seed, rate), GAS_ERRORS[kind])
            for seed in seeds
        }

    return scenes


def gas_text(count: int, seconds: float, seed: int, rate: int) -> str:
    random = np.random.default_rng(seed)
    places = list(itertools.product(np.linspace(-0.4, 0.4, 6), repeat=3))
    bodies = walls(LEVEL, 0.5)
    for k, at in enumerate(random.permutation(len(places))[:count]):
        v = random.normal(size=3)
        start = np.array(places[at]) + random.uniform(-0.02, 0.02, 3)
        bodies[f"b{k}"] = LEVEL.body(sphere(0.05), start, v / np.linalg.norm(v))
    return LEVEL.config(bodies, rate, seconds, ELASTIC, (0, 0, 0))


def momentum_off(states: States) -> float:
    """Return the most by which a step's momentum is not what walls gave it, over all speeds."""
    fixed = [states.names.index(name) for name in states.names if name[0] != "b"]
    rows = states.contact
    first, other = np.isin(rows["body_a"], fixed), np.isin(rows["body_b"], fixed)
    sign = (first.astype(float) - other) * rows["impulse_n"]  # the impulse is on B
    pushed = np.zeros((len(states.time), 3))
    np.add.at(pushed, rows["step"], np.stack([rows[f"n{c}"] for c in "xyz"], -1) * sign[:, None])
    momentum = states.velocity.sum(axis=1)
    off = np.diff(momentum, axis=0) - pushed[1:]
    return float(np.abs(off).max() / np.linalg.norm(states.velocity[0], axis=1).sum())


def kolmogorov(states: States) -> float:
    """Return sqrt(N) D of the speeds at the end against Maxwell's: 1.63 is left by 1 % of gases."""
    from scipy import stats  # late: a second of whoever collects the tests of this file

    balls = [k for k, name in enumerate(states.names) if name[0] == "b"]
    speeds = np.linalg.norm(states.velocity[-1, balls], axis=1)
    scale = math.sqrt(1.0 / 3.0)  # of each component, all at 1 m/s before
    return float(stats.kstest(speeds, stats.maxwell(scale=scale).cdf).statistic * len(balls) ** 0.5)


GAS_ERRORS = {"energy": energy_off, "momentum": momentum_off, "speeds": kolmogorov}


def corners(rate: int) -> Scenes:
    """A smooth ball into corners, at once and in turn: every wall turns its velocity round."""
    found = {}
    for count, how, aim in itertools.product((2, 3), ("at once", "in turn"), range(4)):
        away = np.zeros(3)
        away[:count] = [(1, 1, 1), (1, 2, 3), (3, 1, 0.5), (1, 5, 2)][aim][:count]
        away /= np.linalg.norm(away)
        start = np.zeros(3)
        start[:count] = 0.05
        start += (0.3 + 3.0 / rate * aim / 4.0) * away
        if how == "in turn":
            start[:count] += np.array([0.0, 0.004, 0.010])[:count]
        world = (LEVEL, TURNED)[aim % 2]
        bodies = {f"wall{k}": plane(world.turn.apply(np.eye(3)[k])) for k in range(count)}
        bodies["ball"] = world.body(sphere(0.05), start, -3.0 * away)
        seconds = (0.3 + 3.0 / rate + 0.010 / min(away[:count])) / 3.0 + 2.0 / rate
        text = world.config(bodies, rate, seconds, ELASTIC, (0, 0, 0))

        def error(states: States, world: World = world, away: np.ndarray = away) -> float:
            fast = world.level(states.of("ball")[1][-1])
            return float(np.abs(fast - 3.0 * away).max())

        found[f"{count} walls {how}, {aim}"] = text, error
    return found


def racks(kind: str):
    """The break of 15 balls at 8 m/s."""

    def scenes(rate: int) -> Scenes:
        found = {}
        for gap, aside in ((1e-5, 0.0), (1e-5, 0.004), (1e-6, 0.001), (1e-3, 0.002)):
            radius = 0.0285
            pitch = 2.0 * radius + gap
            bodies = {
                f"b{row}{k}": LEVEL.body(
                    sphere(radius), (row * pitch * math.sqrt(0.75), (k - 0.5 * row) * pitch, 0)
                )
                for row in range(5)
                for k in range(row + 1)
            }
            bodies["cue"] = LEVEL.body(sphere(radius), (-0.4, aside, 0), (8, 0, 0))
            text = LEVEL.config(bodies, rate, 0.5, ELASTIC, (0, 0, 0))
            found[f"gap {gap:g}, {aside:g} aside"] = text, energy_off if kind == "energy" else deep
        return found

    def deep(states: States) -> float:
        """Return the deepest overlap at the end of a step, over the radius."""
        worst = 0.0
        for places in states.place:
            apart = np.linalg.norm(places[:, None] - places[None], axis=2)
            worst = max(worst, 2.0 * 0.0285 - apart[np.triu_indices(len(places), 1)].min())
        return float(worst / 0.0285)

    return scenes


NONE = math.inf
E6 = (1e-6, 1e-6, 1e-6)
E9 = (1e-9, 1e-9, 1e-9)
ROWS = (
    Row("cradles of seven with gaps [m, m/s]", "0.5, 0.5, 0.5", cradles, E6, plan="balls"),
    Row("the same: energy", "12 %, 4.7 to 6.9 %, -", cradles_energy, E9, plan="balls"),
    Row("balls on balls, dropped [m, m/s]", "1.9, 1.6, 0.8", towers, E6, plan="balls"),
    Row("rows of balls of falling masses [m, m/s]", "stands still, right, right",
        falling_masses, E6, plan="balls"),
    Row("gas of 100, 10 s: energy", "52 %, 19 %, 2 %", gas(100, 10.0, "energy"), E9, plan="balls"),
    Row("gas of 200, 10 s: energy", "", gas(200, 10.0, "energy"), E9, plan="balls"),
    Row("the same: momentum of a step", "", gas(200, 2.0, "momentum"), (1e-12,) * 3, plan="balls"),
    Row("the same: sqrt(N) D against Maxwell, 200 balls", "",
        gas(200, 10.0, "speeds", (3,)), (1.63,) * 3, plan="balls"),
    Row("ball into corners of two and three walls [m/s]", "energy 0.5 to 0.64", corners, E6,
        plan="balls"),
    Row("break of 15: energy", "-, 4.3 %, -", racks("energy"), E9, plan="balls"),
    Row("the same: overlap, of a radius", "-, 1, -", racks("overlap"), (1e-5,) * 3, plan="balls"),
)  # fmt: skip
