"""Bodies that turn meet with whatever of them is there first, and lie on flush tiles unmoved.

Conservation laws and Newton's first law. All scenes are run in one engine.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, plane, run_scenes

RATES = (60, 240, 1000)  # steps a second
WALL = 0.4
SECONDS = {60: 6.0, 240: 6.0, 1000: 1.5}
SHAPES = {
    "disc": "{kind: cylinder, radius: 0.15, length: 0.02}",
    "needle": "{kind: cylinder, radius: 0.05, length: 0.5}",
    "pyramid": "{kind: hull, points: [[0, 0, 0], [0.3, 0, 0], [0.3, 0.3, 0], [0, 0.3, 0], "
    "[0.1, 0.1, 0.02]]}",
}
# Of a capsule and a cylinder that lie: place along x and y, course and yaw [degrees], speed [m/s].
LYING = [
    ("capsule", (0.28, -0.72), 45.0, 20.0, 12.0, 60),
    ("cylinder", (0.1, -0.85), 0.0, 77.0, 25.0, 240),
    ("cylinder", (0.22, -0.8), 0.0, 14.0, 25.0, 240),
    ("capsule", (0.11, -0.87), 30.0, 61.0, 25.0, 60),
]


def body(shape: str, place: tuple[float, ...], velocity: tuple[float, ...], more: str) -> str:
    return (
        f"{{shape: {shape}, mass: 1.3, surface: one, position: {flow(place)}, "
        f"velocity: {flow(velocity)}{more}}}"
    )


def between_walls(shape: str, seed: int, rate: int) -> str:
    """A thin body turns and flies in a box of elastic walls."""
    draw = np.random.default_rng(seed)
    bodies = {
        f"wall{k}{side}": plane(sign * np.eye(3)[k], -WALL)
        for k in range(3)
        for side, sign in (("low", 1.0), ("high", -1.0))
    }
    turned, spin = draw.normal(size=4), draw.normal(0.0, 6.0, 3)
    more = f", orientation: {flow(turned)}, angular_velocity: {flow(spin)}"
    bodies["body"] = body(SHAPES[shape], (0, 0, 0), tuple(draw.normal(0.0, 1.5, 3)), more)
    return config(bodies, rate, SECONDS[rate])


def lying(number: int) -> str:
    """A round body lies and slides, askew, at many times its size a step over flush tiles."""
    kind, place, course, yaw, speed, rate = LYING[number]
    bodies = {}
    for i in range(8):
        for j in range(8):
            at = (0.4 * (i - 0.5), 0.4 * (j - 3.5), -0.0625)
            bodies[f"tile{i}_{j}"] = (
                "{shape: {kind: box, size: [0.4, 0.4, 0.125]}, fixed: true, surface: one, "
                f"position: {flow(at)}}}"
            )
    half, a = math.sqrt(0.5), math.radians(yaw) / 2.0
    # Yaw after a quarter of a turn about x.
    turned = half * np.array([math.cos(a), math.cos(a), math.sin(a), math.sin(a)])
    c = math.radians(course)
    velocity = (speed * math.cos(c), speed * math.sin(c), 0.0)
    shape = f"{{kind: {kind}, radius: 0.1, length: 0.3}}"
    bodies["body"] = body(shape, (*place, 0.1), velocity, f", orientation: {flow(turned)}")
    steps = math.floor(2.0 / speed * rate)
    return config(bodies, rate, steps / rate, surface="friction: 0", gravity=repr(GRAVITY))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {
        f"walls {shape} {seed} {rate}": between_walls(shape, seed, rate)
        for shape in SHAPES
        for seed in range(6)
        for rate in RATES
    }
    return run_scenes(texts | {f"lying {number}": lying(number) for number in range(len(LYING))})


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("shape", SHAPES)
def test_thin_body_between_elastic_walls_keeps_its_energy(
    ran: dict[str, States], shape: str, rate: int
) -> None:
    for seed in range(6):
        states = ran[f"walls {shape} {seed} {rate}"]
        assert states.step["unordered"].sum() == 0
        # Round-off of 1500 steps, each of some 1e-16 of the energy.
        np.testing.assert_allclose(states.energy(), states.energy()[0], rtol=1e-11)


@pytest.mark.parametrize("number", range(len(LYING)))
def test_round_body_slides_askew_over_flush_tiles(ran: dict[str, States], number: int) -> None:
    place, velocity, spin = ran[f"lying {number}"].of("body")
    way = place[0] + np.outer(ran[f"lying {number}"].time, velocity[0])
    # It may sink by the slop of 1e-7 m, and slide what it is tilted by.
    np.testing.assert_allclose(place, way, atol=1e-6, rtol=0)
    assert abs(spin).max() < 1e-6
