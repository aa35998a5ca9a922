"""Rows of statics: springs of contacts, tipping, forces that statics leaves open."""

from __future__ import annotations

import math

import numpy as np

from .row import Row, Scenes
from .scene import (
    GRAVITY,
    LEVEL,
    TURNED,
    States,
    World,
    box,
    cylinder,
    leaning,
    matrix,
    sphere,
)

SPRINGS = ((1.0, 1e-4), (0.2, 1e-4), (3.0, 2e-5))  # mass [kg], compliance [m/N]


def depths(rate: int) -> Scenes:
    """Balls come to rest on damped compliances: depth over that of the load, less 1."""
    found = {}
    for mass, compliance in SPRINGS:
        for name, world in {"": LEVEL, ", turned": TURNED}.items():
            ball = world.body(sphere(0.1), (0, 0, 0.1), mass=mass)
            surface = f"compliance: {compliance!r}, damping_ratio: 0.7"
            bodies = {"floor": world.floor("hard"), "ball": ball}
            text = world.config(bodies, rate, 3.0, surface, surfaces=", hard: {}")
            deep = compliance * mass * GRAVITY

            def error(states: States, world: World = world, deep: float = deep) -> float:
                place = world.level(states.of("ball")[0][-1])
                return abs(float(0.1 - place[2]) / deep - 1.0)

            found[f"{mass:g} kg, {compliance:g} m/N{name}"] = text, error
    return found


def periods(rate: int) -> Scenes:
    """Undamped they swing: the period, of what solves x_k+1 + x_k-1 = 2 cos(omega' dt) x_k."""
    found = {}
    for mass, compliance in SPRINGS[:2]:
        ball = LEVEL.body(sphere(0.1), (0, 0, 0.1), mass=mass)
        bodies = {"floor": LEVEL.floor("hard"), "ball": ball}
        text = LEVEL.config(bodies, rate, 1.0, f"compliance: {compliance!r}", surfaces=", hard: {}")
        deep, omega = compliance * mass * GRAVITY, 1.0 / math.sqrt(mass * compliance)

        def error(
            states: States, deep: float = deep, omega: float = omega, rate: int = rate
        ) -> float:
            x = states.of("ball")[0][:, 2] - (0.1 - deep)
            cosine = float((x[2:] + x[:-2]) @ x[1:-1] / (2.0 * x[1:-1] @ x[1:-1]))
            return abs(math.acos(max(-1.0, min(1.0, cosine))) * rate / omega - 1.0)

        found[f"{mass:g} kg, {compliance:g} m/N"] = text, error
    return found


def uprights(rate: int) -> Scenes:
    """Cylinders on slopes below their tipping angle, 40 azimuths: how far they move [m]."""
    found = {}
    for share, radius, height in ((0.95, 0.1, 0.4), (0.999, 0.1, 0.4), (0.99, 0.05, 0.3)):
        tips = math.atan(radius / (0.5 * height))
        for k in range(40):
            azimuth = 2.0 * math.pi * (k + 0.37) / 40
            angle = share * tips
            out = math.sin(angle) * np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
            gravity = GRAVITY * (out - np.array([0.0, 0.0, math.cos(angle)]))
            bodies = {
                "floor": LEVEL.floor(),
                "upright": LEVEL.body(cylinder(radius, height), (0, 0, 0.5 * height)),
            }
            text = LEVEL.config(bodies, rate, 1.0, "friction: 1.5", gravity)
            found[f"{share} of {math.degrees(tips):.0f} degrees, azimuth {k}"] = text, moved
    return found


def moved(states: States) -> float:
    place, _, _ = states.of("upright")
    return float(np.abs(place - place[0]).max())


def tables(rate: int) -> Scenes:
    """A table of four legs under a load: forces, over the weight, of the least norm."""
    found = {}
    for friction, x, y in ((0.0, 0.25, 0.09), (0.5, 0.25, 0.09), (0.4, -0.1, 0.2)):
        bodies = {
            "floor": LEVEL.floor(),
            "table": LEVEL.body(box(1.0, 0.6, 0.1), (0, 0, 0.05), mass=10.0),
            "load": LEVEL.body(box(0.1, 0.1, 0.1), (x, y, 0.15), mass=40.0),
        }
        text = LEVEL.config(bodies, rate, 0.2, f"friction: {friction!r}")
        weight = 50.0 * GRAVITY
        signs = np.array([(-1, -1), (-1, 1), (1, -1), (1, 1)])
        expected = 0.25 * weight * (1.0 + signs @ (2.0 * 0.8 * x / 1.0, 2.0 * 0.8 * y / 0.6))

        def error(states: States, expected: np.ndarray = expected) -> float:
            pair = {states.names.index("floor"), states.names.index("table")}
            rows = states.contact
            mine = [{a, b} == pair for a, b in zip(rows["body_a"], rows["body_b"], strict=True)]
            rows, worst = rows[mine], 0.0
            for step in (1, int(rows["step"].max())):
                legs = rows[rows["step"] == step]
                force = legs["force_n"][np.lexsort((legs["y"], legs["x"].round(6)))]
                worst = max(worst, np.abs(force - expected).max() / expected.sum())
            return float(worst)

        found[f"load at {x:g}, {y:g}, mu {friction}"] = text, error
    return found


def planks(rate: int) -> Scenes:
    """A plank on two rollers that turn towards each other: place, and yaw, after a second.

    x'' = -mu g x/(a - mu h), h half of its thickness; it neither yaws nor leaves its line.
    """
    found = {}
    for apart, thick, friction, start in ((0.3, 0.04, 0.3, 0.1), (0.4, 0.02, 0.2, -0.15)):
        for name, world in {"": LEVEL, ", turned": TURNED}.items():
            lying = leaning(90.0, "x")
            bodies = {
                side: world.body(
                    cylinder(0.1, 0.4),
                    (sign * apart, 0, 0.1),
                    spin=(0, -30.0 * sign, 0),
                    turn=lying,
                    held="kinematic",
                )
                for side, sign in (("left", -1.0), ("right", 1.0))
            }
            place = (start, 0, 0.2 + 0.5 * thick)
            bodies["plank"] = world.body(box(1.6, 0.3, thick), place, mass=2.0)
            text = world.config(bodies, rate, 1.0, f"friction: {friction!r}")
            omega = math.sqrt(friction * GRAVITY / (apart - 0.5 * friction * thick))

            def error(
                states: States, world: World = world, omega: float = omega, start: float = start
            ) -> float:
                now = world.level(states.of("plank")[0][-1])
                exact = start * math.cos(omega * states.time[-1])
                return float(abs(now[0] - exact) / abs(start))

            found[f"rollers {2 * apart:g} m apart{name}"] = text, error
    return found


def planks_yaw(rate: int) -> Scenes:
    """The same: how far they leave their line [m] or yaw [rad]."""

    def of(world: World):
        def error(states: States) -> float:
            place = world.level(states.of("plank")[0])
            front = world.level(matrix(states.turn[-1, states.names.index("plank")])[:, 0])
            front = front - world.level(matrix(states.turn[0, states.names.index("plank")])[:, 0])
            return float(max(np.abs(place[:, 1]).max(), abs(front[1])))

        return error

    return {
        name: (text, of(TURNED if "turned" in name else LEVEL))
        for name, (text, _) in planks(rate).items()
    }


NONE = math.inf
ROWS = (
    Row("ball at rest on a compliance: depth", "300 %, 300 %, 300 %", depths, (1e-6,) * 3,
        plan="springs"),
    Row("the same, undamped: period", "", periods, (NONE, NONE, 0.01), smooth=True, plan="springs"),
    Row("upright cylinder below its tipping angle, 1 s [m]", "-, half fall or creep, -",
        uprights, (1e-6,) * 3),
    Row("table of four legs: forces, of the weight", "-, 0.2, -", tables, (1e-6,) * 3),
    Row("plank on two turning rollers: place", "", planks, (NONE, NONE, 0.01), smooth=True),
    Row("the same: yaw, or off its line [rad, m]", "", planks_yaw, (1e-6,) * 3),
)  # fmt: skip
