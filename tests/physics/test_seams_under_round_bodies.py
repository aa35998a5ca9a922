"""What rolls or slides over the seams of flush tiles moves as on one plane: straight on.

As a body crosses a seam the tile ahead begins at an edge, and the one behind ends at one: neither
may push. A fast one has left the tile behind by the middle of its step, and is far from the tile
ahead as the step begins. All scenes of a test are run in one engine.
"""

from __future__ import annotations

import itertools
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


RISER, RISES = 1e-4, 2  # [m], the first row of tiles that lie higher
PHASES_AT = {60: 8, 240: 2}  # of a step, in which the riser is met


def tiles(riser: float = 0.0) -> dict[str, str]:
    shape = f"{{kind: box, size: [{SIDE}, {SIDE}, 0.1]}}"
    return {
        f"tile{i}_{j}": f"{{shape: {shape}, fixed: true, surface: one, position: "
        f"{flow((SIDE * i, SIDE * j, (riser if i >= RISES else 0.0) - 0.05))}}}"
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
    for shape, rate in itertools.product(SHAPES, RATES):
        for phase in range(PHASES_AT[rate]):
            start = 0.1 + phase / PHASES_AT[rate] * SPEED / rate, 0.13
            bodies = tiles(RISER) | {"body": rolling(shape, 0.0, start)}
            texts[f"riser {shape} {rate} {phase}"] = config(
                bodies, rate, 0.5, "friction: 0.5", "[0, 0, -9.81]"
            )
    return run_scenes(texts)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("shape", SHAPES)
def test_round_body_that_rolls_against_a_riser_loses_its_share_once(
    ran: dict[str, States], shape: str, rate: int
) -> None:
    """In whatever part of a step it meets it: (1 - (h/R)/(1 + k))^2 of the speed is left.

    k: its inertia about its axis, of m R^2. It then turns about the edge, so that the angular
    momentum about it, m v (R - h) + k m R v, is (1 + k) m R^2 omega; v = omega (R - h) is left
    along the floor. By v^2/R > g it flies off at once, lands, and rolls on after friction has had
    it: (1 + k) v' = v + k omega R.
    """
    cylinder, caps = 0.3, 4.0 / 3.0 * RADIUS  # parts of a capsule's volume, of pi R^2 [m]
    of_capsule = (0.5 * cylinder + 0.4 * caps) / (cylinder + caps)
    k = {"ball": 0.4, "cylinder": 0.5, "capsule": of_capsule}[shape]
    left = (1.0 - RISER / RADIUS / (1.0 + k)) ** 2
    for phase in range(PHASES_AT[rate]):
        _, velocity, _ = ran[f"riser {shape} {rate} {phase}"].of("body")
        # Where it has sunk by the slop of 1e-7 m, the share is off by 2e-6 / (1 + k).
        assert velocity[-1, 0] == pytest.approx(SPEED * left, abs=4e-6, rel=0), phase


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
