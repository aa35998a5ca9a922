"""Rows of what is met and what is not: seams, risers, near misses."""

from __future__ import annotations

import math

import numpy as np

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
    sphere,
)

SIDE = 0.5  # of a tile [m]


def tiles(world: World, way: np.ndarray, riser: float = 0.0) -> dict[str, str]:
    """Return tiles under a way from 0, flush but for those from x = 0.75 on, higher by `riser`."""
    near = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    points = np.linspace(0.0, 1.0, 60)[:, None] * way[:2]
    under = {(int(x) + i, int(y) + j) for x, y in np.round(points / SIDE) for i, j in near}
    shape = box(SIDE, SIDE, 0.1)
    return {
        f"tile{i + 9}_{j + 9}": world.body(
            shape, (SIDE * i, SIDE * j, -0.05 + (riser if i >= 2 else 0.0)), held="fixed"
        )
        for i, j in sorted(under)
    }


HULL = [(-0.1, -0.08, -0.05), (0.1, -0.08, -0.05), (0.0, 0.12, -0.05), (0, 0, 0.15)]


def sliders(rate: int) -> Scenes:
    """Boxes and hulls at any angle slide over tiles until friction stops them, as on one plane."""
    found = {}
    tetrahedron = f"{{kind: hull, points: [{', '.join(map(flow, HULL))}]}}"
    height = sum(point[2] for point in HULL) / 4.0 + 0.05  # of its centre above its face
    for number, (kind, course, yaw, friction, speed) in enumerate(
        (
            ("box", 0.0, 0.0, 0.2, 3.0),
            ("box", 0.0, 17.0, 0.2, 3.0),
            ("box", 17.0, 17.0, 0.1, 2.0),
            ("box", 45.0, 30.0, 0.3, 3.0),
            ("box", 30.0, 0.0, 0.0, 2.0),
            ("hull", 10.0, 40.0, 0.1, 2.0),
        )
    ):
        a = math.radians(course)
        along = np.array([math.cos(a), math.sin(a), 0.0])
        seconds = 1.1 if friction == 0.0 else min(1.6, speed / (friction * GRAVITY) + 0.1)
        slows = friction * GRAVITY
        braked = min(seconds, speed / slows) if slows else seconds
        gone = speed * braked - 0.5 * slows * braked**2
        world = (LEVEL, TURNED)[number % 2]
        shape, high = (box(0.2, 0.2, 0.1), 0.05) if kind == "box" else (tetrahedron, height)
        start = np.array([0.03, 0.02, high])
        turned = leaning(yaw, "z")
        bodies = tiles(world, gone * along) | {
            "body": world.body(shape, start, speed * along, turn=turned)
        }
        text = world.config(bodies, rate, seconds, f"friction: {friction!r}")

        def error(
            states: States,
            world: World = world,
            along: np.ndarray = along,
            speed: float = speed,
            slows: float = slows,
        ) -> float:
            place, _, _ = states.of("body")
            t = states.time[-1]
            braked = min(t, speed / slows) if slows else t
            gone = speed * braked - 0.5 * slows * braked**2
            return float(np.abs(world.level(place[-1] - place[0]) - gone * along).max())

        found[f"{kind}, course {course:g}, yaw {yaw:g}, mu {friction}"] = text, error
    return found


def rollers(rate: int) -> Scenes:
    """Balls, cylinders and capsules that roll over seams keep their velocity."""
    found = {}
    for kind, radius, course, speed in (
        ("ball", 0.1, 0.0, 2.0),
        ("ball", 0.03, 40.0, 5.0),
        ("cylinder", 0.1, 0.0, 2.0),
        ("cylinder", 0.05, 17.0, 2.0),
        ("capsule", 0.1, 0.0, 2.0),
        ("capsule", 0.08, 45.0, 1.0),
    ):
        a = math.radians(course)
        along = np.array([math.cos(a), math.sin(a), 0.0])
        spin = speed / radius * np.cross(UP, along)
        shape = sphere(radius) if kind == "ball" else cylinder(radius, 0.3, kind)
        turn = None if kind == "ball" else leaning(course, "z") * leaning(-90.0, "x")
        for name, world in {"": LEVEL, ", turned": TURNED}.items():
            bodies = tiles(world, 1.0 * speed * along) | {
                "body": world.body(shape, (0.013, 0.021, radius), speed * along, spin, turn)
            }
            text = world.config(bodies, rate, 1.0, "friction: 0.5")

            def error(states: States) -> float:
                _, velocity, _ = states.of("body")
                return float(np.abs(velocity[-1] - velocity[0]).max())

            found[f"{kind}, course {course:g}, {speed:g} m/s{name}"] = text, error
    return found


def risers(rate: int) -> Scenes:
    """Balls meet an edge of 0.1 mm: cos^2 of the speed is left; of 1e-9 m all of it."""
    found = {}
    for height, radius, speed in ((1e-4, 0.1, 2.0), (1e-4, 0.05, 1.0), (1e-9, 0.1, 2.0)):
        for name, world in {"": LEVEL, ", turned": TURNED}.items():
            bodies = tiles(world, np.array([1.5, 0, 0]), height)
            bodies["body"] = world.body(sphere(radius), (0.1, 0.13, radius), (speed, 0, 0))
            seconds = (0.75 - 0.1 + 0.1) / speed
            text = world.config(bodies, rate, seconds, "friction: 0")
            left = ((radius - height) / radius) ** 2 if height > 1e-8 else 1.0

            def error(
                states: States, world: World = world, left: float = left, speed: float = speed
            ) -> float:
                fast = world.level(states.of("body")[1][-1])
                return abs(float(fast[0]) / speed - left)

            found[f"{height:g} m, ball of {radius:g} m{name}"] = text, error
    for height in (1e-9,):
        bodies = tiles(LEVEL, np.array([1.5, 0, 0]), height)
        bodies["body"] = LEVEL.body(box(0.2, 0.2, 0.1), (0.1, 0.13, 0.05), (2.0, 0, 0))
        text = LEVEL.config(bodies, rate, 0.5, "friction: 0")
        found[f"{height:g} m, box"] = text, lambda states: abs(states.of("body")[1][-1, 0] / 2 - 1)
    return found


def misses(rate: int) -> Scenes:
    """Balls, and boxes, that pass each other, over 32 phases: what their velocities change by."""
    found = {}
    for speed in (0.1, 1.0, 5.0, 100.0):
        for radius, gap in ((0.05, 1e-4), (0.01, 2e-6)):
            step = speed / rate
            lead, pitch = max(2.4 * radius, 3.0 * step), 20.0 * radius
            if lead / step > 2000:
                continue
            for part in range(2):  # the plan of few bodies
                bodies = {}
                for phase in range(part, 32, 2):
                    y = pitch * phase
                    start = (-lead - step * phase / 32.0, y + 2.0 * radius + gap, 0)
                    bodies[f"passing{phase}"] = LEVEL.body(sphere(radius), start, (speed, 0, 0))
                    bodies[f"rests{phase}"] = LEVEL.body(sphere(radius), (0, y, 0))
                text = LEVEL.config(bodies, rate, 2.0 * lead / speed, "friction: 0.3", (0, 0, 0))
                found[f"balls of {radius:g} m, {speed:g} m/s, {part}"] = text, deflected
        step = speed / rate
        lead = max(0.3, 3.0 * step)
        if speed < 1.0:
            continue
        bodies = {}
        for phase in range(16):
            y = 2.0 * phase
            start = (-lead - step * phase / 16.0, y + 0.2 + 1e-4, 0)
            bodies[f"passing{phase}"] = LEVEL.body(box(0.2, 0.2, 0.2), start, (speed, 0, 0))
            bodies[f"rests{phase}"] = LEVEL.body(box(0.2, 0.2, 0.2), (0, y, 0))
        text = LEVEL.config(bodies, rate, 2.0 * lead / speed, "friction: 0.3", (0, 0, 0))
        found[f"boxes, {speed:g} m/s"] = text, deflected
    return found


def deflected(states: States) -> float:
    return float(np.abs(states.velocity[-1] - states.velocity[0]).max())


ROWS = (
    Row("box or hull that slides over flush tiles, way [m]", "0.04 to 0.21 of 2.28",
        sliders, (1e-6,) * 3),
    Row("ball, cylinder, capsule that rolls over seams: velocity [m/s]",
        "1.6, 1.1, 0.3", rollers, (1e-6,) * 3),
    Row("riser of 0.1 mm is felt, of 1e-9 m not: speed", "", risers, (1e-5,) * 3),
    Row("near misses, 32 phases: velocity [m/s]", "all at 5 m/s, -", misses, (0.0,) * 3),
)  # fmt: skip
