"""An upright cylinder on a slope tips where statics says, whatever the azimuth and what it is on.

The weight of a cylinder of radius r and length h leaves the disc it stands on at tan(angle) =
r/(h/2). At a thousandth less it stands: steps solved to 1e-9 m/s move it by no more than 1e-9 m a
second. At a thousandth more it falls: it begins 4.6e-4 rad beyond its unstable balance on the rim,
from which it departs by cosh(t/T), T = sqrt(k^2/(g d)) = 0.17 s, k^2 = 5/4 r^2 + h^2/3,
d^2 = r^2 + h^2/4: within 1.4 s it has turned by half a radian.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, config, flow, run_scenes

RADIUS, HEIGHT = 0.1, 0.4
TIPS = math.atan(RADIUS / (HEIGHT / 2.0))
AZIMUTHS = 16
FLOORS = {
    "plane": "{shape: {kind: plane}, surface: one}",
    # Not centred below it: no axis of the face is one of the disc's.
    "box": "{shape: {kind: box, size: [2, 2, 1]}, fixed: true, surface: one, "
    "position: [0.03, 0.02, -0.5]}",
    "cylinder": "{shape: {kind: cylinder, radius: 1, length: 1}, fixed: true, surface: one, "
    "position: [0.03, 0.02, -0.5]}",
}


def leaning(floor: str, share: float, azimuth: float) -> str:
    """Return a config whose gravity is turned instead of its floor; share: of the tipping angle."""
    angle = share * TIPS
    along = math.sin(angle) * np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    gravity = GRAVITY * (along - np.array([0.0, 0.0, math.cos(angle)]))
    shape = f"{{kind: cylinder, radius: {RADIUS}, length: {HEIGHT}}}"
    upright = f"{{shape: {shape}, mass: 1.0, surface: one, position: [0, 0, {HEIGHT / 2.0}]}}"
    bodies = {"floor": FLOORS[floor], "upright": upright}
    # What tips where it should stand, a thousandth of its angle off, begins with 0.001 g sideways:
    # after half a second it is a hundred thousand times as far as is allowed.
    seconds = 3.0 if share > 1.0 else 0.5
    return config(bodies, 240, seconds, "friction: 1.5", flow(gravity))


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    texts = {
        f"{floor} {share} {k}": leaning(floor, share, 2.0 * math.pi * (k + 0.37) / AZIMUTHS)
        for floor in FLOORS
        for share in (0.999, 1.001)
        for k in range(AZIMUTHS)
    }
    return run_scenes(texts)


@pytest.mark.parametrize("floor", FLOORS)
def test_it_stands_a_thousandth_below_its_angle(ran: dict[str, States], floor: str) -> None:
    for k in range(AZIMUTHS):
        place, _, _ = ran[f"{floor} 0.999 {k}"].of("upright")
        assert abs(place - place[0]).max() <= 3e-9


@pytest.mark.parametrize("floor", FLOORS)
def test_it_falls_a_thousandth_above(ran: dict[str, States], floor: str) -> None:
    for k in range(AZIMUTHS):
        states = ran[f"{floor} 1.001 {k}"]
        _, x, y, _ = states.turn[-1, states.names.index("upright")]
        assert 1.0 - 2.0 * (x * x + y * y) < math.cos(0.5)
