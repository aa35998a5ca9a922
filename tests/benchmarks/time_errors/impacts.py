"""Rows of impacts: in their order, at their own times, whatever the timestep."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .row import Row, Scenes
from .scene import (
    LEVEL,
    TURNED,
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
    Row("balls hit across a gap with spin [m/s]", "-, 0.31, 0.058", strikes, E6),
    Row("rocking blocks: first return", "56 %, 21 %, 5 %", rocking, (NONE, 0.01, 0.01)),
    Row("two bodies meet within a step: angular momentum [N m s]", "off", pairs, (1e-11,) * 3),
)  # fmt: skip
