"""An impulse pushes or is exactly zero: separating pairs get 0.0, no row ever pulls."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, resolved, sphere

SEPARATING = {
    "sphere leaving a plane": {
        "floor": plane(),
        "ball": sphere(0.1, (0.0, 0.0, 0.099), velocity=(0.0, 0.0, 1e-6), restitution=1.0),
    },
    "spheres leaving each other": {
        "a": sphere(0.1, (0.0, 0.0, 0.0), velocity=(-1.0, 0.0, 0.0), mass=3.0),
        "b": sphere(0.1, (0.15, 0.05, 0.0), velocity=(0.5, 0.0, 0.0)),
    },
    "box leaving a box": {
        "a": box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), fixed=True),
        "b": box((1.0, 1.0, 1.0), (0.3, 0.0, 0.99), velocity=(0.0, 0.0, 2.0)),
    },
    "sliding along a plane": {
        "floor": plane(),
        "ball": sphere(0.1, (0.0, 0.0, 0.1), velocity=(1.0, 0.0, 0.0)),
    },
}


@pytest.mark.parametrize("name", SEPARATING)
def test_separating_pair_gets_exactly_zero_impulse_and_keeps_its_velocities(name):
    bench = Bench(resolved(SEPARATING[name]))
    before = bench.velocity, bench.spin
    rows = bench.run(1).contact
    assert len(rows)
    assert (rows["approach_velocity"] >= 0.0).all()
    np.testing.assert_array_equal(rows["impulse_n"], 0.0)
    np.testing.assert_array_equal(bench.velocity, before[0])
    np.testing.assert_array_equal(bench.spin, before[1])


def test_no_row_of_a_tumbling_heap_pulls():
    rng = np.random.default_rng(20250701)
    bodies = {"floor": plane(restitution=0.5)}
    for i in range(6):
        quaternion = rng.normal(size=4)
        place = (*rng.uniform(-0.3, 0.3, 2), 0.6 + 0.7 * i)
        bodies[f"box_{i}"] = box(
            (0.6, 0.5, 0.4), place, orientation=quaternion / np.linalg.norm(quaternion)
        )
    numerics = {"stabilisation_gain": 0.02, "projection": 0.2, "slop": 0.001}
    rows = Bench(resolved(bodies, (0.0, 0.0, -9.81), **numerics)).run(480).contact
    assert len(rows) > 1000
    assert (rows["impulse_n"] >= 0.0).all()
    assert (rows["impulse_n"] > 0.0).any()
