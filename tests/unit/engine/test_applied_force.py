"""A constant force and torque on a turned brick: momentum F t, angular momentum T t."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, body, config, resolved

from lavendersim.engine.spec import Spec
from lavendersim.scene.events import EventQueue

TURNING = ("external_force", "gyroscopic", "midpoint", "pose_log", "rotation", "step_log")
BRICK = {"kind": "box", "size": [0.2, 0.3, 0.5]}
FORCE, TORQUE = np.array([3.0, -2.0, 5.0]), np.array([0.02, 0.05, -0.03])


@pytest.mark.parametrize("mass", [0.5, 20.0])
def test_from_rest_impulses_of_force_and_torque_are_the_momenta(mass: float) -> None:
    """Angular momentum is about the origin, where the brick is; L = T dt whatever its inertia.

    One step of 1/240 s: some 50 roundings of 1.1e-16.
    """
    cell = resolved(
        {"one": body(BRICK, mass=mass, orientation=(0.5, 0.1, -0.7, 0.5))}, timestep="1/240"
    )
    cell["scene"]["forces"] = [
        {"body": "one", "from": 0.0, "to": 1.0, "force": [*FORCE], "torque": [*TORQUE]}
    ]
    bench = Bench(cell, Spec(effects=TURNING))
    EventQueue(bench.engine, bench.scene, config(cell).events).apply_due(0)
    after = bench.run(1).step[-1]
    momentum = [after[f"momentum_{axis}"] for axis in "xyz"]
    angular = [after[f"angular_momentum_{axis}"] for axis in "xyz"]
    np.testing.assert_allclose(momentum, FORCE / 240.0, rtol=1e-14)
    # the centre has moved along the force by then, so its momentum has no moment about the origin
    np.testing.assert_allclose(angular, TORQUE / 240.0, rtol=1e-14)
