"""The projection of what a spring draws into a floor: the spring gains no energy by it."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import plane, resolved, sphere


@pytest.mark.parametrize("sweeps", [1, 50])
def test_projection_does_no_work_on_a_spring(sweeps: int) -> None:
    """The ball begins 5 mm deep; to lift it out would stretch the spring by as much."""
    bodies = {
        "floor": plane(),
        "hook": sphere(0.01, (0.0, 0.0, -0.5), fixed=True),
        "ball": sphere(0.1, (0.0, 0.0, 0.095)),
    }
    cell = resolved(bodies, (0.0, 0.0, 0.0), timestep="1/240", integrator="midpoint_contact")
    cell["numerics"] |= {"projection": 0.2, "projection_sweeps": sweeps}
    cell["scene"]["springs"] = [{"a": "hook", "b": "ball", "stiffness": 1e4, "rest_length": 0.5}]
    bench = interpreted_bench(cell)
    energy = np.array([bench.run(1).step[-1]["spring_energy"] for _ in range(20)])
    first = 0.5 * 1e4 * 0.095**2
    assert energy.max() <= first * (1.0 + 1e-9)
