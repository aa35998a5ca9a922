"""Rows without impacts: what rolls, pivots, spins, slides or rides on what turns."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation

from tests.oracle.rolling_motion import Rolling, disc, on_a_tip

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
    flow,
    leaning,
    matrix,
    sphere,
)

WORLDS = {"": LEVEL, ", turned": TURNED}


def energy_off(states: States) -> float:
    """Return the largest change of the energy, over that of the start."""
    energy = states.energy()
    return float(np.abs(energy / energy[0] - 1.0).max())


def drop_of_energy(world: World, body: str):
    """Return the same with the height above the floor of the body's world, wherever that is."""

    def error(states: States) -> float:
        place, _, _ = states.of(body)
        kinetic = states.step["kinetic_energy"]
        # One body of 1 kg.
        energy = kinetic + GRAVITY * world.level(place)[:, 2]
        return float(np.abs(energy / energy[0] - 1.0).max())

    return error


def axis_off(world: World, body: str, motion: Rolling, turn: np.ndarray, spin: np.ndarray):
    """Return how far [rad] the axis ends from where the ODE has it."""
    known: list[np.ndarray] = []

    def error(states: States) -> float:
        if not known:
            known.append(motion.after(float(states.time[-1]), turn, spin)[1][:, 2])
        found = world.level(matrix(states.turn[-1, states.names.index(body)])[:, 2])
        return float(np.linalg.norm(found - known[0]))

    return error


def discs(rate: int) -> dict[str, tuple[str, object]]:
    """Discs on their edges: degrees from lying flat, ratio of steady rolling, so much faster."""
    found = {}
    for radius, length, tilt, ratio, faster in (
        (0.05, 0.005, 30.0, None, 1.1),
        (0.05, 0.005, 30.0, -3.0, 1.0),
        (0.1, 0.004, 20.0, None, 1.05),
        (0.03, 0.01, 50.0, -6.0, 0.95),
    ):
        turn, motion = leaning(tilt), disc(radius, length)
        axis = turn.as_matrix()[:, 2]
        if ratio is None:  # its centre at rest, when steady
            ratio = -(axis[2] - 0.5 * length / radius * axis[0])
        spin = faster * motion.steady(turn.as_matrix(), ratio) * (UP + ratio * axis)
        for name, world in WORLDS.items():
            text = rolling(world, cylinder(radius, length), motion, turn, spin, rate, 1.0)
            found[f"{tilt:g} degrees {ratio:.2g}{name}"] = (
                text,
                world,
                motion,
                turn.as_matrix(),
                spin,
            )
    return found


def rolling(
    world: World, shape: str, motion: Rolling, turn: Rotation, spin: np.ndarray, rate: int, s: float
) -> str:
    p, _ = motion.arm(turn.as_matrix(), spin)
    body = world.body(shape, (0, 0, -p[2]), np.cross(p, spin), spin, turn)
    return world.config({"floor": world.floor(), "body": body}, rate, s, "friction: 2")


def disc_energy(rate: int) -> Scenes:
    return {
        name: (text, drop_of_energy(world, "body"))
        for name, (text, world, *_) in discs(rate).items()
    }


def disc_axis(rate: int) -> Scenes:
    return {
        name: (text, axis_off(world, "body", motion, turn, spin))
        for name, (text, world, motion, turn, spin) in discs(rate).items()
    }


def coins(rate: int) -> Scenes:
    """A coin on its edge spins about the vertical; leaning a little it wobbles."""
    found = {}
    for radius, length, tilt, about in ((0.012, 0.002, 85.0, 40.0), (0.02, 0.001, 80.0, 25.0)):
        motion, turn = disc(radius, length), leaning(tilt)
        spin = about * UP
        for name, world in WORLDS.items():
            text = rolling(world, cylinder(radius, length), motion, turn, spin, rate, 1.0)
            found[f"{tilt:g} degrees{name}"] = text, drop_of_energy(world, "body")
    return found


def pyramid(sides: int, radius: float, height: float) -> tuple[str, np.ndarray]:
    """Return a hull that stands on its tip, and its moments for 1 kg."""
    angles = 2.0 * math.pi * np.arange(sides) / sides
    ring = [(radius * math.cos(a), radius * math.sin(a), 0.25 * height) for a in angles]
    points = ", ".join(flow(point) for point in [*ring, (0, 0, -0.75 * height)])
    polar = radius**2 / 6.0 * (2.0 + math.cos(2.0 * math.pi / sides))  # of the base, over its area
    across = 0.6 * (0.5 * polar + height**2) - (0.75 * height) ** 2
    return f"{{kind: hull, points: [{points}]}}", np.array([across, across, 0.6 * polar])


def tops(rate: int) -> Scenes:
    found = {}
    for sides, radius, height, tilt, ratio, faster in (
        (16, 0.05, 0.08, 20.0, 30.0, 1.0),
        (12, 0.06, 0.06, 35.0, 12.0, 1.0),
        (16, 0.05, 0.08, 25.0, 20.0, 1.1),
    ):
        shape, moments = pyramid(sides, radius, height)
        motion, turn = on_a_tip(moments, (0, 0, -0.75 * height), 0.0), leaning(tilt)
        start = turn.as_matrix()
        spin = faster * motion.steady(start, ratio) * (UP + ratio * start[:, 2])
        for name, world in WORLDS.items():
            text = rolling(world, shape, motion, turn, spin, rate, 1.0)
            found[f"{sides} sides, {tilt:g} degrees{name}"] = (
                text,
                axis_off(world, "body", motion, start, spin),
            )
    return found


def table(world: World, rate: float, radius: float) -> str:
    return world.body(cylinder(radius, 0.1), (0, 0, -0.05), spin=(0, 0, rate), held="kinematic")


def riders(margin: float):
    """Blocks that turn with a table, with `margin` of the friction that takes."""

    def scenes(rate: int) -> Scenes:
        found = {}
        for turns, radius in ((math.pi, 0.5), (4.0, 0.3), (2.0, 0.8)):
            for name, world in WORLDS.items():
                block = world.body(
                    box(0.1, 0.1, 0.1),
                    (radius, 0, 0.05),
                    (0, radius * turns, 0),
                    (0, 0, turns),
                )
                friction = margin * turns**2 * radius / GRAVITY
                bodies = {"table": table(world, turns, 1.2), "block": block}
                text = world.config(bodies, rate, 3.0, f"friction: {friction!r}")

                def error(states: States, world: World = world, radius: float = radius) -> float:
                    place = world.level(states.of("block")[0][-1])
                    return abs(math.hypot(*place[:2]) - radius) / radius

                found[f"{turns:.2g} rad/s at {radius:g} m{name}"] = text, error
        return found

    return scenes


def slopes(rate: int) -> Scenes:
    """Boxes that slide and balls and cylinders that roll down slopes, from rest, for a second."""
    found = {}
    for angle, azimuth, friction in ((30.0, 0.0, 0.3), (20.0, 0.7, 0.35), (12.0, 2.1, 0.15)):
        a = math.radians(angle)
        down = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
        gravity = GRAVITY * (math.sin(a) * down - math.cos(a) * UP)
        lying = leaning(math.degrees(azimuth), "z") * leaning(90.0, "x")
        kinds = {
            "box": (box(0.2, 0.3, 0.1), 0.05, None, None),
            "ball": (sphere(0.07), 0.07, None, 0.4),
            "cylinder": (cylinder(0.1, 0.3), 0.1, lying, 0.5),
        }
        for kind, (shape, height, turn, inertia) in kinds.items():
            for name, world in WORLDS.items():
                sliding = GRAVITY * (math.sin(a) - friction * math.cos(a))
                rolls = 0.0 if inertia is None else GRAVITY * math.sin(a) / (1.0 + inertia)
                fast = sliding if inertia is None else rolls
                bodies = {
                    "floor": world.floor(),
                    "body": world.body(shape, (0, 0, height), turn=turn),
                }
                text = world.config(bodies, rate, 1.0, f"friction: {friction!r}", gravity)

                def error(
                    states: States, world: World = world, way: np.ndarray = 0.5 * fast * down
                ) -> float:
                    place = world.level(states.of("body")[0])
                    off = np.linalg.norm(place[-1] - place[0] - way * states.time[-1] ** 2)
                    return float(off / np.linalg.norm(way))

                found[f"{kind}, {angle:g} degrees{name}"] = text, error
    return found


def circles(rate: int) -> Scenes:
    """Balls that roll on a turntable circle at 2/7 of its rate: the angle after 2 s [rad]."""
    found = {}
    for turns, speed, radius in ((3.0, 0.6, 0.1), (5.0, 0.8, 0.05)):
        start, velocity = np.array([0.3, 0, radius]), np.array([0.0, speed, 0])
        spin = np.cross(UP, velocity - turns * np.cross(UP, start)) / radius
        for name, world in WORLDS.items():
            ball = world.body(sphere(radius), start, velocity, spin)
            text = world.config({"table": table(world, turns, 3.0), "ball": ball}, rate, 2.0)

            def error(states: States, world: World = world, turns: float = turns) -> float:
                x, y, _ = world.level(states.of("ball")[1][-1])
                angle = math.atan2(-x, y) - 2.0 / 7.0 * turns * states.time[-1]
                return abs(math.remainder(angle, math.tau))

            found[f"{turns:g} rad/s{name}"] = text, error
    return found


def carried(rate: int) -> Scenes:
    """Boxes on a lift that moves evenly, on a belt, on a table that turns: drift over their way."""
    found = {}
    for name, world in WORLDS.items():
        way = np.array([0.9, 0.4, 0.0])
        lift = world.body(box(3.0, 3.0, 0.2), (0, 0, -0.1), way, held="kinematic")
        block = world.body(box(0.2, 0.2, 0.3), (0.3, 0.2, 0.15), way)
        text = world.config({"lift": lift, "block": block}, rate, 2.0, "friction: 0.3")

        def error(states: States) -> float:
            gone = [states.of(body)[0] for body in ("block", "lift")]
            drift = (gone[0] - gone[0][0]) - (gone[1] - gone[1][0])
            return float(np.abs(drift).max() / np.linalg.norm(gone[1][-1] - gone[1][0]))

        found[f"lift{name}"] = text, error
        turns, radius = 2.5, 0.6
        bodies = {
            "table": table(world, turns, 1.2),
            "block": world.body(
                box(0.1, 0.1, 0.1), (radius, 0, 0.05), (0, radius * turns, 0), (0, 0, turns)
            ),
        }
        text = world.config(bodies, rate, 2.0, "friction: 0.6")

        def drift(states: States, world: World = world) -> float:
            place, turn = states.of("block")[0], states.turn[:, states.names.index("table")]
            frames = Rotation.from_quat(turn, scalar_first=True)
            local = frames.inv().apply(place)
            way = 2.5 * 0.6 * states.time[-1]
            return float(np.abs(local - local[0]).max() / way)

        found[f"table{name}"] = text, drift
    return found


def constant(rate: int) -> Scenes:
    """Oblique gravity in flight, and on a floor that a box slides over as friction pulls, too.

    It is thrown along what of gravity lies in the floor, so friction keeps its direction.
    """
    found = {}
    for number, (across, thrown, friction) in enumerate(((1.7, 3.0, 0.1), (0.6, 2.0, 0.05))):
        along = np.array([math.cos(0.4 + number), math.sin(0.4 + number), 0.0])
        gravity = across * along - 9.0 * UP
        for name, world in WORLDS.items():
            bodies = {
                "floor": world.floor(),
                "flies": world.body(box(0.1, 0.2, 0.3), (0, 0, 50.0), (3, 1, 2)),
                "slides": world.body(box(0.2, 0.3, 0.1), (5, 0, 0.05), thrown * along),
            }
            text = world.config(bodies, rate, 1.0, f"friction: {friction!r}", gravity)
            pulls = {"flies": gravity, "slides": (across - 9.0 * friction) * along}

            def error(
                states: States, world: World = world, pulls: dict[str, np.ndarray] = pulls
            ) -> float:
                worst, t = 0.0, states.time[-1]
                for body, pull in pulls.items():
                    place, velocity, _ = states.of(body)
                    gone, fast = world.level(place[-1] - place[0]), world.level(velocity[-1])
                    start = world.level(velocity[0])
                    worst = max(worst, np.abs(gone - start * t - 0.5 * pull * t**2).max())
                    worst = max(worst, np.abs(fast - start - pull * t).max())
                return float(worst)

            found[f"{across:g} m/s^2{name}"] = text, error
    return found


NONE = math.inf
ROWS = (
    Row("disc that rolls on its edge, 1 s: energy", "-, 94 %, 26 %", disc_energy,
        (NONE, NONE, 0.01), smooth=True),
    Row("the same: axis [rad]", "", disc_axis, (NONE, NONE, 0.01), smooth=True),
    Row("coin that spins on its edge: energy", "-, 12 %, 2.6 %", coins,
        (NONE, NONE, 0.01), smooth=True),
    Row("heavy top on its tip, 1 s: axis [rad]", "-, 36 deg, 6.5 deg", tops,
        (NONE, NONE, 0.01), smooth=True),
    Row("block on a turntable, mu 1.5 of what is needed: radius", "50 %, 10 %, 2.4 %",
        riders(1.5), (NONE, NONE, 0.01), smooth=True),
    Row("the same at mu 1.01", "1240 %, 800 %, 74 %", riders(1.01),
        (NONE, NONE, 0.01), smooth=True),
    Row("slides or rolls down a slope: distance", "1.7 %, 0.42 %, 0.1 %", slopes,
        (1e-9, 1e-9, 1e-9)),
    Row("ball that rolls on a turntable: angle [rad]", "", circles,
        (NONE, NONE, 0.01), smooth=True),
    Row("sticks on what moves or turns: drift of its way", "", carried, (1e-6, 1e-6, 1e-6)),
    Row("constant forces, in flight and sliding [m, m/s]", "", constant, (1e-9, 1e-9, 1e-9)),
)  # fmt: skip
