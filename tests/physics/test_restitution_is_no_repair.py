"""Restitution answers an impact; it does not lift a body out of a penetration it rests in."""

from __future__ import annotations

import pytest
from physics_runs import GRAVITY, run_config

SUNK = """
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 2.0
      surface: {{restitution: 1}}
      position: [0, 0, 0.095]
numerics: {{preset: chapter, stabilisation_gain: 0, projection: 0, restitution_threshold: {}}}
duration: 0.2
sweep:
  e: {{path: scene.bodies.ball.surface.restitution, values: [0, 0.5, 1]}}
"""
WEIGHT = 2.0 * GRAVITY
DEPTH = 0.005


def test_resting_penetration_stays_whatever_the_restitution() -> None:
    for course in run_config(SUNK.format(2.0)):
        depth = 0.1 - course.height("ball")
        # Nothing asks the ball to move: only the round-off of v += g dt, v += j/m is left.
        assert depth == pytest.approx(DEPTH, abs=1e-12)
        assert course.contact["force_n"] == pytest.approx(WEIGHT, rel=1e-12)


def test_bouncing_on_the_resting_approach_makes_the_force_cycle() -> None:
    # 48 steps: at g dt^2 in two, the ball stays inside and each of its contacts is a resting one.
    dead, _, lively = run_config(SUNK.format(0.0))
    assert dead.contact["force_n"] == pytest.approx(WEIGHT, rel=1e-12)
    # At e = 1 a step that approaches at g dt leaves at g dt: its force is 2 m g, the next one's 0.
    force = lively.contact["force_n"]
    assert force[::2] == pytest.approx(2 * WEIGHT, rel=1e-9)
    assert force[1::2] == pytest.approx(0, abs=1e-9 * WEIGHT)
    # It does creep out, but with a force that never settles.
    risen = lively.height("ball")[-1] - lively.height("ball")[0]
    assert risen == pytest.approx(GRAVITY * lively.dt**2 * 24, rel=1e-6)
