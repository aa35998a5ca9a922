"""What a spring off the centres of two bodies does in one step, about every axis."""

from __future__ import annotations

import numpy as np
import pytest
from convex import matrix_of
from interpreted_steps import Steps
from laboratory import body, resolved

from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("pose_log", "rotation", "spring", "step_log"))
BRICK = {"kind": "box", "size": [0.2, 0.3, 0.5]}
POINTS = {"a": (0.05, 0.1, -0.2), "b": (-0.1, 0.07, 0.15)}
TURNS = {"a": (0.8, 0.2, -0.4, 0.4), "b": (0.5, -0.5, 0.1, 0.7)}
PLACES = {"a": (0.0, 0.0, 0.0), "b": (0.7, -0.4, 0.9)}


def test_it_pulls_both_bodies_by_one_impulse_at_its_points() -> None:
    """m dv = P and I dw = r x P for A, and the opposite for B, by what the step begins with."""
    bodies = {
        name: body(BRICK, PLACES[name], mass=mass, orientation=TURNS[name])
        for name, mass in (("a", 1.3), ("b", 2.1))
    }
    cell = resolved(bodies, timestep="1/50")
    cell["scene"]["springs"] = [
        {"a": "a", "b": "b", "point_a": POINTS["a"], "point_b": POINTS["b"],
         "stiffness": 80.0, "damping": 3.0, "rest_length": 0.4}
    ]  # fmt: skip
    steps = Steps(cell, SPEC)
    steps.run(1)
    speed, spin = steps.velocities, steps.vectors(steps.engine.velocities, "w")
    impulse = 1.3 * speed[0]
    assert np.linalg.norm(impulse) > 0.1
    for k, (name, mass, sign) in enumerate((("a", 1.3, 1.0), ("b", 2.1, -1.0))):
        # Orientations of a config are normalised.
        matrix = matrix_of(np.array(TURNS[name]) / np.linalg.norm(TURNS[name]))
        inertia = matrix @ np.diag(bodies[name]["inertia"]) @ matrix.T
        np.testing.assert_allclose(mass * speed[k], sign * impulse, atol=1e-14)
        moment = np.cross(matrix @ POINTS[name], sign * impulse)
        np.testing.assert_allclose(inertia @ spin[k], moment, atol=1e-14)


@pytest.mark.parametrize("fixed", ["a", "b"])
def test_the_log_has_the_impulse_that_a_fixed_end_gives(fixed: str) -> None:
    """The momentum of the body that moves; two that move give each other theirs."""
    for mass in (1.3, None):
        bodies = {
            name: body(BRICK, PLACES[name], mass=1.3, **{"fixed": name == fixed and mass is None})
            for name in "ab"
        }
        cell = resolved(bodies, timestep="1/50")
        cell["scene"]["springs"] = [
            {"a": "a", "b": "b", "point_a": (0, 0, 0), "point_b": (0, 0, 0),
             "stiffness": 80.0, "damping": 3.0, "rest_length": 0.4}
        ]  # fmt: skip
        steps = Steps(cell, SPEC)
        row = steps.run(1)[0]
        momentum = 1.3 * steps.velocities.sum(axis=0)
        found = [row[f"spring_impulse_{axis}"] for axis in "xyz"]
        np.testing.assert_allclose(found, momentum, atol=1e-14)
        assert (np.linalg.norm(momentum) > 0.1) == (mass is None)
