"""A bounce made by the penetration bias follows the luck of the release, not e^2 h."""

from __future__ import annotations

from math import sqrt

import pytest
from physics_runs import GRAVITY, first_apex, run_config

H, R = 1.0, 0.1
PHASES = "[" + ", ".join(f"{k}/16" for k in range(16)) + "]"
DROPS = f"""
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball:
      shape: {{kind: sphere, radius: {R}}}
      mass: 1.0
      surface: {{restitution: 0.8}}
      release: {{above: floor, clearance: {H}, phase: 0}}
numerics: {{preset: chapter, timestep: 1/480, stabilisation_gain: 0, slop: 0, projection: 0}}
duration: 1.0
sweep:
  - e: {{path: scene.bodies.ball.surface.restitution, values: [0.8]}}
    phase: {{path: scene.bodies.ball.release.phase, values: {PHASES}}}
  - e: {{path: scene.bodies.ball.surface.restitution, values: [0]}}
    gain: {{path: numerics.stabilisation_gain, values: [0.8]}}
    phase: {{path: scene.bodies.ball.release.phase, values: {PHASES}}}
"""


@pytest.fixture(scope="module")
def rebounds() -> dict[float, list[float]]:
    found: dict[float, list[float]] = {}
    for course in run_config(DROPS):
        found.setdefault(course.coordinates["e"], []).append(first_apex(course, "ball", R))
    return found


def test_restitution_rebounds_to_the_same_height_from_every_release(
    rebounds: dict[float, list[float]],
) -> None:
    # Phases add 0 .. v dt to h, and the ball is found d = 0 .. v dt inside: it rises to
    # e^2 (h + d) - d and a little more, so rebounds differ by e^2 v dt + (1 - e^2) v dt at most.
    step_of_fall = sqrt(2 * GRAVITY * 1.01 * H) / 480
    assert max(rebounds[0.8]) - min(rebounds[0.8]) < step_of_fall


def test_a_gain_of_the_same_size_rebounds_to_any_height(
    rebounds: dict[float, list[float]],
) -> None:
    # The bias leaves at (beta/dt) d, and the sixteen phases spread d evenly over 0 .. v dt: the
    # unluckiest bounce is below (1/16)^2 of the luckiest, which is (15/16)^2 beta^2 h or more.
    assert max(rebounds[0]) > (15 / 16) ** 2 * 0.64 - 0.01
    assert min(rebounds[0]) < 0.64 / 16**2 + 0.01
