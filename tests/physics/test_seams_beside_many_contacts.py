"""A box slides over the seams of flush tiles as on one plane, however many contacts there are."""

from __future__ import annotations

import math

import pytest
from shared_runs import config, flow, run_scenes

RATE, DURATION, SPEED, YAW = 60, 0.5, 2.0, 0.3
ASIDE = 140  # boxes at rest elsewhere, with four contacts each
START = (-0.6, 0.0, 0.1)


def body(shape: str, position: tuple[float, float, float], rest: str) -> str:
    return f"{{shape: {shape}, surface: one, position: {flow(position)}, {rest}}}"


def bodies(aside: int) -> dict[str, str]:
    tile, box = "{kind: box, size: [0.5, 2, 0.1]}", "{kind: box, size: [0.2, 0.2, 0.2]}"
    slab = "{kind: box, size: [20, 20, 0.2]}"
    turned = flow((math.cos(0.5 * YAW), 0.0, 0.0, math.sin(0.5 * YAW)))
    tiles = {f"tile{i}": body(tile, (0.5 * i, 0, -0.05), "fixed: true") for i in range(-2, 3)}
    resting = {
        f"rest{k}": body(box, (0.5 * (k % 14), 15 + 0.5 * (k // 14), 0.2), "mass: 1")
        for k in range(aside)
    }
    sliding = f"mass: 1, velocity: {flow((SPEED, 0, 0))}, orientation: {turned}"
    return {
        **tiles,
        "floor": body(slab, (0, 20, 0), "fixed: true"),
        **resting,
        "box": body(box, START, sliding),
    }


@pytest.mark.parametrize("aside", [0, ASIDE])
def test_box_slides_over_seams_as_on_a_plane(aside: int) -> None:
    text = config(bodies(aside), RATE, DURATION, "friction: 0", "[0, 0, -9.81]")
    states = run_scenes({"tiles": text})["tiles"]
    place, _, _ = states.of("box")
    assert (states.step["contact_count"][1:] > 4 * aside).all()
    # It may sink by the slop of 1e-7 m, unequally, and slide what it is tilted by.
    assert place[-1] == pytest.approx((START[0] + SPEED * DURATION, 0.0, START[2]), abs=1e-6)
