"""Rows of impacts: in their order, at their own times, whatever the timestep."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from scipy import stats

from tests.oracle.balls_on_a_line import Line

from .row import Row, Scenes
from .scene import (
    GRAVITY,
    LEVEL,
    TURNED,
    UP,
    States,
    World,
    box,
    cylinder,
    leaning,
    matrix,
    plane,
    sphere,
)

WORLDS = {"": LEVEL, ", turned": TURNED}
ELASTIC = "restitution: 1"


def energy_off(states: States) -> float:
    """Return the largest change of the energy, over that of the start."""
    energy = states.energy()
    return float(np.abs(energy / energy[0] - 1.0).max())


def walls(world: World, half: float) -> dict[str, str]:
    """Return six planes around a cube, whose surface is `one`."""
    normals = {f"{side}{k}": sign * np.eye(3)[k] for k in range(3) for side, sign in SIDES.items()}
    return {name: plane(world.turn.apply(normal), -half) for name, normal in normals.items()}


SIDES = {"low": 1.0, "high": -1.0}


def free_box(rate: int) -> Scenes:
    found = {}
    for number, size in enumerate(((0.2, 0.3, 0.4), (0.1, 0.35, 0.2), (0.25, 0.25, 0.25))):
        world = (LEVEL, TURNED)[number % 2]
        moving = world.body(box(*size), (0.02, -0.03, 0.01), (1.3, 0.9, -0.7), (2.0 + number, 3, 1))
        bodies = walls(world, 0.4) | {"box": moving}
        found[f"box {size}"] = world.config(bodies, rate, 20.0, ELASTIC, (0, 0, 0)), energy_off
    moving = LEVEL.body(cylinder(0.1, 0.3), (0.02, -0.03, 0.01), (1.3, 0.9, -0.7), (2, 3, 1))
    bodies = walls(LEVEL, 0.4) | {"cylinder": moving}
    found["cylinder"] = LEVEL.config(bodies, rate, 5.0, ELASTIC, (0, 0, 0)), energy_off
    return found


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
    masses: Sequence[float], radius: float, gaps: Sequence[float], lead: float, struck: int
) -> tuple[Line, np.ndarray, np.ndarray]:
    """Return a row, its places and velocities: the first `struck` balls at 1 m/s, `lead` away."""
    count = len(masses)
    apart = np.array([2.0 * radius + gap for gap in gaps])
    apart[struck - 1] += lead
    if struck > 1:
        apart[: struck - 1] = 2.0 * radius + 1e-3
    place = np.concatenate([[0.0], np.cumsum(apart)])
    velocity = np.where(np.arange(count) < struck, 1.0, 0.0)
    return Line(np.array(masses, dtype=float), np.full(count, radius)), place, velocity


def cradles(rate: int, energy: bool = False) -> Scenes:
    found = {}
    for gap in (1e-6, 1e-5, 1e-4, 1e-2):
        for struck, masses in (
            (2, [1.0] * 7),
            (3, [0.4] * 7),
            (1, [1.0, 1.7, 1.0, 0.6, 1.0, 2.0, 1.0]),
        ):
            gaps = [gap * (1.0 + 0.1 * k) for k in range(6)]
            line, place, velocity = row_of(masses, 0.05, gaps, 0.05 + 0.4 / rate, struck)
            world = TURNED if struck == 3 else LEVEL
            text, error = line_scene(world, line, place, velocity, rate, 0.25)
            found[f"gap {gap:g} m, {struck} strike"] = text, energy_off if energy else error
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


def strikes(rate: int) -> Scenes:
    """A ball that spins strikes another across a gap, off its middle, once: Coulomb's impact."""
    found = {}
    for number, (friction, restitution, mass, aside) in enumerate(
        (
            (0.3, 0.9, 1.0, 0.0),
            (0.05, 1.0, 0.5, 0.02),
            (0.8, 0.5, 2.0, 0.03),
            (0.1, 0.95, 1.0, 0.01),
        )
    ):
        radius, gap = 0.03, 0.05
        normal = np.array([math.sqrt(4.0 * radius**2 - aside**2), aside, 0.0]) / (2.0 * radius)
        start = -np.array([normal[0] * 2.0 * radius + gap, 0.0, 0.0])
        start[1] = -aside
        velocity, spin = np.array([3.0, 0, 0]), np.array([20.0, -35, 60]) * (1 + number) / 2.0
        slip = velocity + np.cross(spin, radius * normal)  # of one on two
        closing = float(slip @ normal)
        along = slip - closing * normal
        push = (1.0 + restitution) * closing * mass / (1.0 + mass)
        hold = np.linalg.norm(along) / (3.5 * (1.0 + 1.0 / mass))
        drag = along / np.linalg.norm(along) * min(friction * push, hold)
        impulse = push * normal + drag  # on two
        final = {
            "one": (
                velocity - impulse,
                spin - np.cross(radius * normal, impulse) / (0.4 * radius**2),
            ),
            "two": (
                impulse / mass,
                np.cross(-radius * normal, impulse) / (0.4 * mass * radius**2),
            ),
        }
        for name, world in WORLDS.items():
            bodies = {
                "one": world.body(sphere(radius), start, velocity, spin),
                "two": world.body(sphere(radius), (0, 0, 0), mass=mass),
            }
            surface = f"friction: {friction!r}, restitution: {restitution!r}"
            text = world.config(bodies, rate, 0.1, surface, (0, 0, 0))

            def error(states: States, world: World = world, final: dict = final) -> float:
                worst = 0.0
                for body, (fast, turning) in final.items():
                    _, v, w = states.of(body)
                    worst = max(worst, np.abs(world.level(v[-1]) - fast).max())
                    worst = max(worst, 0.03 * np.abs(world.level(w[-1]) - turning).max())
                return float(worst)

            found[f"mu {friction}, e {restitution}, masses 1:{mass}{name}"] = text, error
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
    balls = [k for k, name in enumerate(states.names) if name[0] == "b"]
    speeds = np.linalg.norm(states.velocity[-1, balls], axis=1)
    scale = math.sqrt(1.0 / 3.0)  # of each component, all at 1 m/s before
    return float(stats.kstest(speeds, stats.maxwell(scale=scale).cdf).statistic * len(balls) ** 0.5)


GAS_ERRORS = {"energy": energy_off, "momentum": momentum_off, "speeds": kolmogorov}


def rocking(rate: int) -> Scenes:
    """Blocks released on an edge at half of their angle: first return, by Housner's closed form."""
    found = {}
    for width, height in ((0.1, 0.35), (0.15, 0.8), (0.2, 0.5), (0.03, 0.12)):
        alpha = math.atan2(width, height)
        kept = (1.0 - 1.5 * math.sin(alpha) ** 2) ** 2
        drop = math.cos(0.5 * alpha) - math.cos(alpha)
        exact = alpha - math.acos(math.cos(alpha) + kept * drop)
        c, s = math.cos(0.5 * alpha), math.sin(0.5 * alpha)
        centre = (-width * c + height * s, 0.0, width * s + height * c)
        for name, world in WORLDS.items():
            block = world.body(
                box(2 * width, 0.4, 2 * height), centre, turn=leaning(math.degrees(0.5 * alpha))
            )
            bodies = {"floor": world.floor(), "block": block}
            text = world.config(bodies, rate, 2.5, "friction: 5")

            def error(states: States, world: World = world, exact: float = exact) -> float:
                number = states.names.index("block")
                tops = world.level(np.array([matrix(q)[:, 2] for q in states.turn[:, number]]))
                angle = -np.arctan2(tops[:, 0], tops[:, 2])
                landed = int(np.argmax(angle > 0.0))
                peak = landed + int(np.argmax(np.diff(angle[landed:]) < 0.0))
                before, at, after = angle[peak - 1 : peak + 2]
                top = at - (after - before) ** 2 / (8.0 * (after - 2.0 * at + before))
                return abs(float(top) / exact - 1.0)

            found[f"{width:g} by {height:g}{name}"] = text, error
    return found


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


def moments(shape: str, size: Sequence[float], mass: float) -> np.ndarray:
    if shape == "box":
        squares = np.array(size) ** 2
        return mass * (squares.sum() - squares) / 12.0
    if shape == "cylinder":
        about = mass * (size[0] ** 2 / 4.0 + size[1] ** 2 / 12.0)
        return np.array([about, about, 0.5 * mass * size[0] ** 2])
    return np.full(3, 0.4 * mass * size[0] ** 2)


def pairs(rate: int) -> Scenes:
    """Two bodies that turn meet within a step, with friction: angular momentum about the origin."""
    found = {}
    kinds = {"box": box, "sphere": sphere, "cylinder": cylinder}
    for number, (one, two, friction, restitution) in enumerate(
        (
            (("box", (0.3, 0.2, 0.12)), ("sphere", (0.08,)), 0.0, 1.0),
            (("box", (0.3, 0.2, 0.12)), ("sphere", (0.08,)), 0.5, 0.6),
            (("box", (0.2, 0.2, 0.3)), ("box", (0.1, 0.25, 0.15)), 0.4, 0.5),
            (("sphere", (0.1,)), ("sphere", (0.06,)), 0.3, 0.8),
            (("cylinder", (0.1, 0.2)), ("box", (0.2, 0.1, 0.3)), 0.3, 0.3),
        )
    ):
        masses = (1.5, 0.7)
        toward = np.array([1.0, 0.2 * number - 0.3, 0.4])
        toward /= np.linalg.norm(toward)
        centre, aside = np.array([0.7, -0.4, 0.5]), np.array([0.01, 0.03, -0.02])
        far = 0.5 + 4.0 / rate * number / 5.0
        bodies = {
            "one": LEVEL.body(
                kinds[one[0]](*one[1]), centre, (0.3, -0.4, 0.2), (2, -1, 3), leaning(40), mass=1.5
            ),
            "two": LEVEL.body(
                kinds[two[0]](*two[1]),
                centre + aside - far * toward,
                4.0 * toward,
                (-5, 7, 4),
                leaning(25, "x"),
                mass=0.7,
            ),
        }
        surface = f"friction: {friction!r}, restitution: {restitution!r}"
        text = LEVEL.config(bodies, rate, 0.4, surface, (0, 0, 0))
        solids = {
            name: (mass, moments(*shape, mass))
            for name, shape, mass in zip(bodies, (one, two), masses, strict=True)
        }

        def error(states: States, solids: dict = solids) -> float:
            total = sum(
                angular(states, states.names.index(name), *solid) for name, solid in solids.items()
            )
            assert np.abs(states.velocity[-1] - states.velocity[0]).max() > 0.1
            return float(np.abs(total - total[0]).max())

        found[f"{one[0]} and {two[0]}, mu {friction}"] = text, error
    return found


def angular(states: States, number: int, mass: float, inertia: np.ndarray) -> np.ndarray:
    """Return the angular momentum of a body about the origin after every step, (k + 1, 3)."""
    frames = np.array([matrix(q) for q in states.turn[:, number]])
    spin = np.einsum("kij,ki->kj", frames, states.spin[:, number])
    own = np.einsum("kij,kj->ki", frames, inertia * spin)
    return own + mass * np.cross(states.place[:, number], states.velocity[:, number])


NONE = math.inf
E6 = (1e-6, 1e-6, 1e-6)
E9 = (1e-9, 1e-9, 1e-9)
ROWS = (
    Row("free body between elastic walls, 20 s: energy", "65 %, 17 %, 16 %", free_box, E6),
    Row("cradles of seven with gaps [m, m/s]", "0.5, 0.5, 0.5", cradles, E6, plan="balls"),
    Row("the same: energy", "12 %, 4.7 to 6.9 %, -", cradles_energy, E9, plan="balls"),
    Row("balls on balls, dropped [m, m/s]", "1.9, 1.6, 0.8", towers, E6, plan="balls"),
    Row("balls struck across a gap with spin [m/s]", "-, 0.31, 0.058", strikes, E6),
    Row("rows of balls of falling masses [m, m/s]", "stands still, right, right",
        falling_masses, E6, plan="balls"),
    Row("gas of 100, 10 s: energy", "52 %, 19 %, 2 %", gas(100, 10.0, "energy"), E9, plan="balls"),
    Row("gas of 200, 10 s: energy", "", gas(200, 10.0, "energy"), E9, plan="balls"),
    Row("the same: momentum of a step", "", gas(200, 2.0, "momentum"), (1e-12,) * 3, plan="balls"),
    Row("the same: sqrt(N) D against Maxwell, 200 balls", "",
        gas(200, 10.0, "speeds", (3,)), (1.63,) * 3, plan="balls"),
    Row("rocking blocks: first return", "56 %, 21 %, 5 %", rocking, (NONE, 0.01, 0.01)),
    Row("ball into corners of two and three walls [m/s]", "energy 0.5 to 0.64", corners, E6,
        plan="balls"),
    Row("break of 15: energy", "-, 4.3 %, -", racks("energy"), E9, plan="balls"),
    Row("the same: overlap, of a radius", "-, 1, -", racks("overlap"), (1e-5,) * 3, plan="balls"),
    Row("two bodies meet within a step: angular momentum [N m s]", "off", pairs, (1e-11,) * 3),
)  # fmt: skip
