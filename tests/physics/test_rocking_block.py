"""A block that rocks loses what Housner's closed form says as it lands on its other edge.

About the edge it lands on angular momentum is kept, omega+ = (1 - 3/2 sin^2 alpha) omega- with
alpha the angle between a side and the diagonal; between landings energy is kept (G. W. Housner,
1963). All scenes are run in one engine.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, run_scenes

RATES = (240, 480, 1000)  # steps a second
BLOCKS = [(0.1, 0.35), (0.15, 0.8), (0.2, 0.5), (0.05, 0.5)]  # half width, half height [m]
RELEASED = 0.5  # of the angle at which it would topple


def scene(width: float, height: float, rate: int) -> str:
    """The block is released at rest on one edge, which is at the origin."""
    angle = RELEASED * math.atan2(width, height)
    c, s = math.cos(angle), math.sin(angle)
    centre = (-width * c + height * s, 0.0, width * s + height * c)
    turned = (math.cos(angle / 2.0), 0.0, math.sin(angle / 2.0), 0.0)
    block = (
        f"{{shape: {{kind: box, size: {flow((2 * width, 0.4, 2 * height))}}}, mass: 1.0, "
        f"surface: one, position: {flow(centre)}, orientation: {flow(turned)}}}"
    )
    bodies = {"floor": "{shape: {kind: plane}, surface: one}", "block": block}
    return config(bodies, rate, 2.5, surface="friction: 5", gravity=repr(GRAVITY))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    names = [(w, h, rate) for w, h in BLOCKS for rate in RATES]
    return run_scenes({f"{w} {h} {rate}": scene(w, h, rate) for w, h, rate in names})


def first_return(states: States) -> float:
    """Return the largest angle [rad] on the other edge, by the parabola through three states."""
    turn = states.turn[:, states.names.index("block")]
    angle = -2.0 * np.arctan2(turn[:, 2], turn[:, 0])
    landed = int(np.argmax(angle > 0.0))
    peak = landed + int(np.argmax(np.diff(angle[landed:]) < 0.0))
    before, at, after = angle[peak - 1 : peak + 2]
    return float(at - (after - before) ** 2 / (8.0 * (after - 2.0 * at + before)))


CASES = [(*block, rate) for block in BLOCKS for rate in RATES]


@pytest.mark.parametrize(("width", "height", "rate"), CASES)
def test_block_returns_to_the_angle_of_housner(
    ran: dict[str, States], width: float, height: float, rate: int
) -> None:
    """The edge it pivots about overlaps by up to the slop: it does not hide the edge that lands."""
    diagonal, alpha = math.hypot(width, height), math.atan2(width, height)
    kept = (1.0 - 1.5 * math.sin(alpha) ** 2) ** 2  # of the energy
    drop = math.cos((1.0 - RELEASED) * alpha) - math.cos(alpha)
    exact = alpha - math.acos(math.cos(alpha) + kept * drop)
    # It topples at the rate p, p^2 = 3 g/(4 R); an error of second order in p dt, three times over:
    # of the fall, of the rise, and of the angle for their energy.
    bound = 3.0 * 0.75 * GRAVITY / diagonal / rate**2
    assert bound < 0.0011
    assert first_return(ran[f"{width} {height} {rate}"]) == pytest.approx(exact, rel=bound)
