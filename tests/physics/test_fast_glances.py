"""Balls that fly past each other fast meet where their paths say, if only by a hair.

Smooth balls of 1 kg and radius R, e = 1, without gravity: one stands, the other passes its centre
at the distance b < 2 R. They meet where the centres are 2 R apart, and exchange what they have of
the velocity along the line of centres, at the angle asin(b/(2 R)) to the path.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from shared_runs import ball, config, run_scenes

RADIUS = 0.05  # [m]
SPEEDS = (20.0, 70.0, 300.0)  # [m/s]
SHARES = (0.3, 0.9, 0.99, 0.9999)  # b/(2 R)
PHASES = 16
RATE, STEPS = 60, 3


def passing(speed: float, share: float, phase: int) -> str:
    """Return a config in which they meet in the second step, at one of PHASES times."""
    b, when = 2.0 * RADIUS * share, (1.0 + (phase + 0.5) / PHASES) / RATE
    before = math.sqrt(4.0 * RADIUS * RADIUS - b * b)
    stands = ball(RADIUS, 1.0, (0.0, 0.0, 0.0))
    flies = ball(RADIUS, 1.0, (-before - speed * when, b, 0.0), (speed, 0.0, 0.0))
    # Bodies that turn are followed, as they may meet with any point of theirs.
    flies = flies.replace("surface:", "angular_velocity: [0, 0, 1], surface:")
    return config({"stands": stands, "flies": flies}, RATE, STEPS / RATE)


@pytest.mark.parametrize("share", SHARES)
def test_fast_balls_that_glance_off_each_other_are_not_missed(share: float) -> None:
    """To 1e-6 of the speed: the time of the impact turns the line of centres by v dt/(2 R), found
    to a quarter of what counts as touching, 1e-9 m."""
    scenes = itertools.product(SPEEDS, range(PHASES))
    texts = {f"{speed} {phase}": passing(speed, share, phase) for speed, phase in scenes}
    sine, cosine = share, math.sqrt(1.0 - share * share)
    line = np.array([cosine, -sine, 0.0])
    for name, found in run_scenes(texts).items():
        speed = float(name.split()[0])
        hit = speed * cosine * line
        _, stands, _ = found.of("stands")
        _, flies, _ = found.of("flies")
        np.testing.assert_allclose(stands[-1], hit, atol=1e-6 * speed, err_msg=name)
        np.testing.assert_allclose(flies[-1], (speed, 0.0, 0.0) - hit, atol=1e-6 * speed)
