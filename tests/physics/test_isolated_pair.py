"""Two bodies on which nothing else acts keep momentum and angular momentum through a bounce."""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import run_config

SWEEPS = 22
PAIR = """
scene:
  gravity: 0
  bodies:
    one:
      shape: {{kind: sphere, radius: 0.2}}
      mass: 1.5
      surface: {{restitution: 0.6}}
      position: [-0.5, 0.1, 0.05]
      velocity: [2, 0.1, 0]
    other: {}
numerics: {{preset: chapter, projection: {}}}
duration: 0.6
"""
SPHERE = """
      shape: {kind: sphere, radius: 0.25}
      mass: 0.7
      position: [0.5, 0, 0]
      velocity: [-1, 0, 0.2]
"""
BOX = """
      shape: {kind: box, size: [0.3, 0.6, 0.4]}
      mass: 0.7
      position: [0.5, 0.2, 0]
      orientation: {axis: [1, 2, 3], degrees: 20}
      velocity: [-1, 0, 0.2]
      angular_velocity: [0.5, -1, 2]
"""
AXES = "xyz"


def drift(rows: np.ndarray, quantity: str) -> float:
    """Return the largest change of a vector quantity over a run."""
    vectors = np.column_stack([rows[f"{quantity}_{axis}"] for axis in AXES])
    return float(np.abs(vectors - vectors[0]).max())


@pytest.mark.parametrize("projection", [0, 0.2])
@pytest.mark.parametrize("other", [SPHERE, BOX], ids=["sphere", "box"])
def test_momentum_is_kept_through_the_bounce(other: str, projection: float) -> None:
    (course,) = run_config(PAIR.format(other, projection))
    touching = course.contact[course.contact["impulse_n"] > 0]
    assert len(touching), "the bodies were to meet"
    # Each visit of a row rounds both velocities once; both bodies carry less than 4 kg m/s.
    round_off = SWEEPS * len(course.contact) * 2.2e-16 * 4.0
    assert drift(course.step, "momentum") <= round_off
    energy = course.step["kinetic_energy"]
    assert energy[-1] < 0.9 * energy[0], "e = 0.6 was to take energy"


@pytest.mark.parametrize("other", [SPHERE, BOX], ids=["sphere", "box"])
def test_angular_momentum_is_kept_without_projection(other: str) -> None:
    # Moving bodies without velocity changes x cross m v; contact impulses do not.
    (course,) = run_config(PAIR.format(other, 0))
    # As above, and every step rounds the positions (below 1 m from the origin) and rotations.
    operations = SWEEPS * len(course.contact) + 20 * len(course.step)
    assert drift(course.step, "angular_momentum") <= operations * 2.2e-16 * 4.0
