"""Dominoes that fall on each other: what one step leaves undone does not spread to the next ones.

Bricks as wide as each other have edges above each other, and points of either's by round-off; one
that leans on the next turns about an edge that lies a slop above the floor, and comes back to it.
"""

from __future__ import annotations

import numpy as np
from shared_runs import config, plane, run_scenes

from lavendersim.engine.approach import OVERLAP

COUNT, GAP = 8, 0.03
WIDE, TALL = 0.01, 0.1  # [m]


def row() -> str:
    bodies = {"floor": plane()}
    for k in range(COUNT):
        at = f"position: [{k * (WIDE + GAP)!r}, 0, {TALL / 2}], surface: one, mass: 0.1"
        push = "" if k else ", velocity: [0.2, 0, 0], angular_velocity: [0, 4, 0]"
        bodies[f"domino_{k + 1}"] = (
            f"{{shape: {{kind: box, size: [{WIDE}, 0.05, {TALL}]}}, {at}{push}}}"
        )
    return config(bodies, 240, 0.35, "friction: 0.3", "9.81")


def test_every_middle_of_a_step_is_found_and_nothing_overlaps() -> None:
    """Five of them lean on each other by then. The bound is that from which order is given up."""
    states = run_scenes({"dominoes": row()})["dominoes"]
    turned = 2.0 * np.arccos(np.abs(states.turn[-1, :, 0]))
    assert np.count_nonzero(turned > 0.1) >= 5
    assert not states.step["midpoint_not_converged"].any()
    assert states.step["max_penetration"].max() < OVERLAP
