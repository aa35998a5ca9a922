"""What rolls or slides over the seams of flush tiles moves as on one plane: straight on.

As a body crosses a seam the tile ahead begins at an edge, and the one behind ends at one: neither
may push. A fast one has left the tile behind by the middle of its step, and is far from the tile
ahead as the step begins. All scenes of a test are run in one engine.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import States, config, flow, run_scenes

RATES = (60, 240)
RADIUS, SIDE = 0.1, 0.5  # of the body, of a tile [m]
# Along the tiles with the seam under the whole of a cylinder, askew, and over their corners.
ANGLES = (0.0, 0.3, math.pi / 4)
STARTS = ((0.0031, 0.0), (0.17, -0.07))  # [m]; the first with tiles side by side
SHAPES = {
    "ball": "{kind: sphere, radius: 0.1}",
    "cylinder": "{kind: cylinder, radius: 0.1, length: 0.3}",
    "capsule": "{kind: capsule, radius: 0.1, length: 0.3}",
}
SPEED, DURATION = 2.0, 1.0
CASES = [(shape, rate, angle) for shape in SHAPES for rate in RATES for angle in ANGLES]


def tiles() -> dict[str, str]:
    shape = f"{{kind: box, size: [{SIDE}, {SIDE}, 0.1]}}"
    return {
        f"tile{i}_{j}": f"{{shape: {shape}, fixed: true, surface: one, position: "
        f"{flow((SIDE * i, SIDE * j, -0.05))}}}"
        for i in range(-1, 6)
        for j in range(-1, 5)
    }


def lying_across(angle: float) -> tuple[float, float, float, float]:
    """Return the turn of the z axis into the horizontal one to the left of `angle`."""
    half, c, s = math.sqrt(0.5), math.cos(0.5 * angle), math.sin(0.5 * angle)
    return (half * c, half * c, half * s, half * s)


def rolling(shape: str, angle: float, start: tuple[float, float]) -> str:
    along, aside = math.cos(angle), math.sin(angle)
    spin = SPEED / RADIUS
    turned = "" if shape == "ball" else f", orientation: {flow(lying_across(angle))}"
    return (
        f"{{shape: {SHAPES[shape]}, mass: 1.0, surface: one, position: {flow((*start, RADIUS))}, "
        f"velocity: {flow((SPEED * along, SPEED * aside, 0))}, "
        f"angular_velocity: {flow((-spin * aside, spin * along, 0))}{turned}}}"
    )


def name_of(shape: str, rate: int, angle: float, start: tuple[float, float]) -> str:
    return f"{shape} {rate} {angle:.1f} {start}"


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {
        name_of(shape, rate, angle, start): config(
            tiles() | {"body": rolling(shape, angle, start)},
            rate,
            DURATION,
            "friction: 0.5",
            "[0, 0, -9.81]",
        )
        for shape, rate, angle in CASES
        for start in STARTS
    }
    return run_scenes(texts)


@pytest.mark.parametrize(("shape", "rate", "angle"), CASES)
def test_round_body_rolls_over_seams_as_on_a_plane(
    ran: dict[str, States], shape: str, rate: int, angle: float
) -> None:
    for start in STARTS:
        place, velocity, _ = ran[name_of(shape, rate, angle, start)].of("body")
        way = place[-1] - place[0]
        straight = SPEED * DURATION * np.array([math.cos(angle), math.sin(angle), 0.0])
        # Solves leave 1e-9 m/s in each of up to eight seams.
        assert np.abs(way - straight).max() < 8e-9
        assert np.abs(velocity[-1] - velocity[0]).max() < 8e-9


FAST = (1.0, 4.0, 15.0, 60.0)  # [m/s]; at 60 a second the last is two tiles a step
ASKEW = [
    (shape, rate, speed) for shape in ("capsule", "cylinder") for rate in RATES for speed in FAST
]
PHASES, STEPS = 6, 24
COURSE, GOLDEN = 0.35, 0.6180339887498949


def sliding(shape: str, rate: int, speed: float, phase: int) -> str:
    """It lies at some angle to its way, above tiles around the way only, without friction."""
    angle, shift = 2.4 * phase, SIDE * (GOLDEN * phase % 1.0)
    towards = np.array([math.cos(COURSE), math.sin(COURSE)])
    velocity, place = (*(speed * towards), 0.0), (shift, 0.7 * shift, RADIUS)
    body = (
        f"{{shape: {SHAPES[shape]}, mass: 1.0, surface: one, position: {flow(place)}, "
        f"velocity: {flow(velocity)}, orientation: {flow(lying_across(angle))}}}"
    )
    way = np.linspace(-0.5, speed * STEPS / rate + 0.5, 400)[:, None] * towards
    near = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    under = {(int(x) + i, int(y) + j) for x, y in np.round(way / SIDE) for i, j in near}
    shape_of_tile = f"{{kind: box, size: [{SIDE}, {SIDE}, 0.1]}}"
    below = {
        f"tile{i + 9}_{j + 9}": f"{{shape: {shape_of_tile}, fixed: true, surface: one, "
        f"position: {flow((SIDE * i, SIDE * j, -0.05))}}}"
        for i, j in sorted(under)
    }
    return config(below | {"body": body}, rate, STEPS / rate, "friction: 0", "[0, 0, -9.81]")


@pytest.fixture(scope="module")
def slid() -> dict[str, States]:
    return run_scenes(
        {
            f"{shape} {rate} {speed} {phase}": sliding(shape, rate, speed, phase)
            for shape, rate, speed in ASKEW
            for phase in range(PHASES)
        }
    )


@pytest.mark.parametrize(("shape", "rate", "speed"), ASKEW)
def test_round_body_that_lies_askew_slides_over_seams_as_on_a_plane(
    slid: dict[str, States], shape: str, rate: int, speed: float
) -> None:
    for phase in range(PHASES):
        place, velocity, spin = slid[f"{shape} {rate} {speed} {phase}"].of("body")
        straight = velocity[0] * STEPS / rate
        # Solves leave 1e-9 m/s, along the normals of some two seams a step.
        assert np.abs(place[-1] - place[0] - straight).max() < 2 * STEPS * 1e-9 * max(1.0, speed)
        assert np.abs(velocity[-1] - velocity[0]).max() < 2 * STEPS * 1e-9
        assert RADIUS * np.abs(spin[-1]).max() < 2 * STEPS * 1e-9
