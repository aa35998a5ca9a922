"""Friction stays within a cone that is another in each step, where a solve has nothing to do.

A step begins with the impulses of the step before. Where the coefficient has fallen as a body
slides faster, or the ellipse has turned with a grain, they lie outside; a solve whose residual is
within its tolerance nevertheless would leave them there.
"""

from __future__ import annotations

import numpy as np
import pytest
from physics_runs import run_config

# A ball that cannot roll is pushed harder than friction holds it; velocities are known to 5 cm/s.
SLIDING = """
question: Is friction within its cone?
expected: It is.
scene:
  surfaces: {{one: {{friction: 0.2, {surface}}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: one}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, inertia: [1e6, 1e6, 1e6],
      position: [0, 0, 0.1], velocity: [0.05, 0, 0], surface: one{body}}}
  forces: [{{body: ball, force: [6, 0, 0]}}]
numerics: {{timestep: 1/240, sweeps: 20, tolerance: 0.05, warm_start: true, {solver}}}
duration: 0.1
always: {{}}
measure: {{path: {{kind: displacement, body: ball, along: [1, 0, 0]}}}}
expect: [{{name: moved, measure: path, at_most: 1}}]
"""
FALLING = "static_friction: 0.6, stribeck_velocity: 0.1"
CASES = {
    "falling": (FALLING, "", "solver: block_gauss_seidel, friction_cone: convex"),
    "falling square": (FALLING, "", "solver: jacobi, friction_cone: pyramid"),
    "turning": (
        "across_grain: 0.1",
        ", angular_velocity: [0, 0, 5], grain: [1, 0.5, 0]",
        "solver: jacobi",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_impulses_that_are_kept_are_within_the_cone_of_the_step(case: str) -> None:
    surface, body, solver = CASES[case]
    text = SLIDING.format(surface=surface, body=body, solver=solver)
    course = run_config(text, interpreted=True)[0]
    rows, one, two = course.contact, *(course.contact[f"impulse_t{k}"] for k in (1, 2))
    slides = np.maximum(abs(one), abs(two)) if "pyramid" in solver else np.hypot(one, two)
    assert (rows["impulse_n"] > 0.0).sum() > 10
    # Impulses are brought to the cone by a rounded length: some units in the last place.
    assert (slides <= rows["friction"] * rows["impulse_n"] * (1.0 + 1e-12)).all()
