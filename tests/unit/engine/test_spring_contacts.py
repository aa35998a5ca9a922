"""A spring that presses a body against a floor: its force is that of its stretch, at any stiffness.

In closed form: nothing moves, so F = k s, and what the contact gives in a step is F dt.
"""

from __future__ import annotations

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import box, plane, resolved, sphere

STRETCH, STEPS = 0.02, 20
DT = 1.0 / 240.0


@pytest.mark.parametrize("stiffness", [1e2, 1e5, 1e8])
@pytest.mark.parametrize("even", [True, False])
def test_body_pressed_by_a_spring_stays_with_the_force_of_its_stretch(
    stiffness: float, even: bool
) -> None:
    pressed = sphere(0.1, (0.0, 0.0, 0.1)) if even else box((0.3, 0.4, 0.2), (0.0, 0.0, 0.1))
    bodies = {
        "floor": plane(),
        "hook": sphere(0.01, (0.0, 0.0, -0.5), fixed=True),
        "body": pressed,
    }
    cell = resolved(bodies, (0.0, 0.0, 0.0), timestep="1/240", integrator="midpoint_contact")
    cell["scene"]["springs"] = [
        {"a": "hook", "b": "body", "stiffness": stiffness, "rest_length": 0.6 - STRETCH}
    ]
    bench = interpreted_bench(cell)
    rows = bench.run(STEPS)
    force = stiffness * STRETCH
    # A solve ends at 1e-9 m/s, of what forces change in a step by dt F/m.
    np.testing.assert_allclose(rows.step["spring_force"][1:], force, rtol=1e-6)
    last = rows.contact[rows.contact["step"] == STEPS]
    assert float(last["impulse_n"].sum()) == pytest.approx(force * DT, rel=1e-6)
    assert abs(bench.engine.velocities["vz"]).max() <= 1e-8
