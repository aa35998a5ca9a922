"""A plate that is put down askew rocks, claps and slides to rest on a floor, and then stays.

A cap touches a floor in points of its rim, where it meets it next: those of a plate that lies
change from step to step. Once it rests nothing may keep it moving: steps are solved to 1e-9 m/s,
and it lies within the slop of 1e-7 m.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, config, flow, plane, run_scenes

SLOP = 1e-7  # [m]
WEIGHT = flow((0.0, 0.0, -GRAVITY))
# Steps a second; radius and thickness; tilt [degrees], about (1, y, 0); height of its lowest point
# above the floor; spin about x and z [rad/s].
PUT_DOWN = {
    "dropped": (60, 0.1391, 0.01391, 24.38, 0.52, 0.0014, (-0.995, -6.0)),
    "spun": (60, 0.14, 0.014, 1.0, 0.52, 0.0, (0.0, -6.0)),
    "spun about a rim": (60, 0.14, 0.014, 3.0, 0.0, 0.0, (0.0, -6.0)),
    "let go": (240, 0.14, 0.014, 3.0, 0.52, 0.0, (0.0, 0.0)),
}


def put_down(name: str) -> str:
    rate, radius, thick, degrees, y, above, (wx, wz) = PUT_DOWN[name]
    tilt = math.radians(degrees)
    height = radius * math.sin(tilt) + 0.5 * thick * math.cos(tilt) + above
    plate = (
        f"{{shape: {{kind: cylinder, radius: {radius}, length: {thick}}}, mass: 0.3, "
        f"surface: one, position: [0, 0, {height!r}], angular_velocity: [{wx}, 0, {wz}], "
        f"orientation: {{axis: [1, {y}, 0], degrees: {degrees}}}}}"
    )
    return config({"floor": plane(), "plate": plate}, rate, 2.0, "friction: 0.1", WEIGHT)


@pytest.mark.parametrize("name", PUT_DOWN)
def test_a_plate_that_is_put_down_comes_to_rest(name: str) -> None:
    (found,) = run_scenes({name: put_down(name)}).values()
    place, velocity, spin = found.of("plate")
    radius, thick = PUT_DOWN[name][1:3]
    # The last half second: as slow as steps are solved, spins at the rim; ten times for their sums.
    still = len(velocity) * 3 // 4
    assert np.linalg.norm(velocity[still:], axis=1).max() < 1e-8
    assert radius * np.linalg.norm(spin[still:], axis=1).max() < 1e-8
    height = place[still:, 2] - 0.5 * thick
    assert np.ptp(height) < 1e-8
    assert abs(height).max() < 2.0 * SLOP
