"""What rolls over the seams of flush tiles rolls as on one plane: straight on, at its speed.

As a body crosses a seam the tile ahead begins at an edge, and the one behind ends at one: neither
may push. All scenes are run in one engine.
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
