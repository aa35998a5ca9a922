"""Bodies that pass each other by more than the slop do not touch, whatever the phase of the steps.

A small ball passes a larger one, by half its size in a step and more: its contact ahead is taken
where the two are nearest, within a step that ends just before or after.
"""

from __future__ import annotations

import numpy as np
import pytest
from shared_runs import States, ball, config, run_scenes

RATE, STEPS, PHASES = 240, 24, 48
LARGE, SMALL = 0.019, 0.0027  # radii [m]
SLOP = 1e-7  # [m]
GAPS = (3 * SLOP, 100 * SLOP)
SPEEDS = (0.33, 0.46, 3.0)  # [m/s]: 0.5 to 4.6 radii of the small ball in a step


def passing(gap: float, speed: float, phase: float) -> str:
    """The small ball is nearest after half of the steps and a share of one."""
    before = speed * (STEPS // 2 + phase) / RATE
    bodies = {
        "large": ball(LARGE, 1.0, (0, 0, 0)),
        "small": ball(SMALL, 1.0, (-before, LARGE + SMALL + gap, 0), (speed, 0, 0)),
    }
    return config(bodies, RATE, STEPS / RATE, surface="restitution: 1, friction: 0.5")


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(
        {
            f"{gap} {speed} {phase}": passing(gap, speed, phase / PHASES)
            for gap in GAPS
            for speed in SPEEDS
            for phase in range(PHASES)
        }
    )


@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("gap", GAPS)
def test_a_miss_by_more_than_the_slop_changes_nothing(
    ran: dict[str, States], gap: float, speed: float
) -> None:
    for phase in range(PHASES):
        states = ran[f"{gap} {speed} {phase}"]
        # To the bit: no impulse acts on either.
        np.testing.assert_array_equal(states.velocity[-1], states.velocity[0])
        assert not states.spin.any()
