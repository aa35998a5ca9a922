"""A corner that lands where the floor grips sticks after one visit, as its block is solved."""

from __future__ import annotations

import numpy as np
import pytest
from convex import matrix_of
from interpreted_steps import Steps
from laboratory import body, plane, resolved

from lavendersim.engine.spec import Spec

SIZE = np.array([0.2, 0.3, 0.5])
TURN = np.array((0.8, 0.3, -0.45, 0.2))
EFFECTS = ("contact_log", "contact_torque", "friction", "rotation", "step_log")


def visited(solver: str, cone: str) -> np.ndarray:
    """Return the velocity of a corner that came down on the floor, after one visit."""
    matrix = matrix_of(TURN / np.linalg.norm(TURN))
    corners = (np.indices((2, 2, 2)).reshape(3, -1).T - 0.5) * SIZE @ matrix.T
    lever = corners[np.argmin(corners[:, 2])]
    bodies = {
        "floor": plane(friction=10.0),
        "box": body(
            {"kind": "box", "size": SIZE.tolist()},
            (0.0, 0.0, -lever[2]),
            mass=1.3,
            orientation=TURN.tolist(),
            velocity=(0.3, -0.2, -1.0),
            angular_velocity=(0.4, 0.1, -0.6),
            friction=10.0,
        ),
    }
    spec = Spec(EFFECTS, ("box_plane",), solver, friction_cone=cone)
    cell = resolved(bodies, solver=solver, friction_cone=cone, sweeps=1)
    steps = Steps(cell, spec)
    rows = steps.run(1)
    assert rows["contact_count"][0] == 1
    speed, spin = steps.velocities[1], steps.vectors(steps.engine.velocities, "w")[1]
    return speed + np.cross(spin, lever)


# Of 1 m/s, by a block whose numbers are some ten of each other: some tens of roundings.
ROUND_OFF = 1e-14


@pytest.mark.parametrize("solver", ["projected_gauss_seidel", "block_gauss_seidel"])
def test_a_sticking_corner_has_no_velocity_after_one_visit(solver: str) -> None:
    np.testing.assert_allclose(visited(solver, "convex"), 0.0, atol=ROUND_OFF)


def test_tangents_are_solved_together_behind_the_normal() -> None:
    """They know what the normal's change has done to them; the normal not yet what they do."""
    velocity = visited("block_gauss_seidel", "pyramid")
    np.testing.assert_allclose(velocity[:2], 0.0, atol=ROUND_OFF)
    assert abs(velocity[2]) > 0.01
