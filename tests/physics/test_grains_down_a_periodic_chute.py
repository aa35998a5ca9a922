"""Grains down a bumpy slope that repeats itself: where it begins is of no matter.

Three balls run down over five fixed ones of a cell of 1 m, and pass its faces again and again. The
same scene moved by half a cell has its faces elsewhere, and moves as the first, moved by as much.
"""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
from shared_runs import GRAVITY, ball, config, flow, run_scenes

RADIUS, LENGTH, SLOPE = 0.1, 1.0, radians(40.0)
DURATION, TOLERANCE = 2.0, 1e-9  # [s], [m/s] of solves


def chute(origin: float) -> str:
    """Return the scene moved by `origin` along x; x leads down the slope."""
    shape = f"{{kind: sphere, radius: {RADIUS}}}"
    bodies = {
        f"bump_{k}": f"{{shape: {shape}, fixed: true, position: {flow((origin + 0.2 * k, 0, 0))}, "
        "surface: one}"
        for k in range(5)
    }
    for k in range(3):
        bodies[f"grain_{k}"] = ball(RADIUS, 1.0, (origin + 0.1 + 0.3 * k, 0.0, 0.2 + 0.02 * k))
    pull = flow((GRAVITY * sin(SLOPE), 0.0, -GRAVITY * cos(SLOPE)))
    text = config(bodies, 240, DURATION, "friction: 0.5", pull)
    return text.replace("scene:\n", f"scene:\n  periodic: {{x: [0, {LENGTH}]}}\n")


def test_a_slope_that_repeats_itself_may_begin_anywhere() -> None:
    runs = run_scenes({"first": chute(0.0), "moved": chute(0.5 * LENGTH)})
    first, moved = (run.place[:, 5:] for run in runs.values())
    assert first[-1, :, 0].min() > 5.0 * LENGTH  # five cells down
    assert (first[:, :, 2] > 0.1).all()  # on the bumps of every one
    # What solves leave, for as long; round-off alone is 1e-16 m, and grows with each strike.
    off = moved - first - (0.5 * LENGTH, 0.0, 0.0)
    np.testing.assert_allclose(off, 0.0, atol=TOLERANCE * DURATION)
    speeds = [run.velocity[240:, 5:, 0].mean() for run in runs.values()]
    np.testing.assert_allclose(speeds[0], speeds[1], rtol=TOLERANCE)
