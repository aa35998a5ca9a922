"""Positional projection moves poses and adds no velocity.

With slop s and share p, one free-falling contact at rest is moved by p (d - s) in a step.
"""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, resolved, sphere

SCENES = {
    "sphere": {"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.09), velocity=(0.0, 0.3, -0.5))},
    "tilted box": {
        "floor": plane(),
        "box": box((1.0, 0.6, 0.4), (0.0, 0.0, 0.21), orientation=(1.0, 0.05, 0.03, 0.0), mass=2.0),
    },
    "spinning box on a box": {
        "a": box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), mass=5.0),
        "b": box((0.5, 0.5, 0.5), (0.3, 0.1, 0.73), angular_velocity=(0.3, 0.2, 3.0)),
    },
}


@pytest.mark.parametrize("name", SCENES)
def test_velocities_of_a_step_are_bit_equal_with_projection_on_and_off(name):
    steps = {}
    for share in (0.0, 0.2):
        bench = Bench(resolved(SCENES[name], (0.0, 0.0, -9.81), projection=share))
        rows = bench.run(1)
        steps[share] = bench.velocity, bench.spin, rows.contact, rows.pose[-1]
    for k in range(3):
        np.testing.assert_array_equal(steps[0.0][k], steps[0.2][k])
    assert not np.array_equal(steps[0.0][3], steps[0.2][3])


def test_a_resting_contact_is_moved_by_its_share_of_the_depth_beyond_slop():
    bodies = {"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.09))}
    rows = Bench(resolved(bodies, projection=0.2, slop=0.001)).run(1)
    assert rows.pose[-1, 1, 2] == pytest.approx(0.09 + 0.2 * (0.01 - 0.001), abs=1e-16)


def test_depth_is_taken_after_the_velocity_step():
    """A ball that leaves at 1.2 m/s rises 5 mm in the step; only the other 4 mm are shared out."""
    bodies = {"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.09), velocity=(0.0, 0.0, 1.2))}
    rows = Bench(resolved(bodies, projection=0.2, slop=0.001)).run(1)
    assert rows.pose[-1, 1, 2] == pytest.approx(0.095 + 0.2 * 0.004, abs=1e-16)


def test_two_movable_bodies_are_moved_in_inverse_proportion_to_their_masses():
    bodies = {
        "light": sphere(0.1, (0.0, 0.0, 0.0), mass=1.0),
        "heavy": sphere(0.1, (0.19, 0.0, 0.0), mass=3.0),
    }
    x = Bench(resolved(bodies, projection=0.2)).run(1).pose[-1, :, 0]
    assert x[0] == pytest.approx(-0.2 * 0.01 * 0.75, abs=1e-16)
    assert x[1] - 0.19 == pytest.approx(0.2 * 0.01 * 0.25, abs=1e-16)


def test_penetration_within_slop_is_left_alone():
    bodies = {"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.0995))}
    rows = Bench(resolved(bodies, projection=0.2, slop=0.001)).run(3)
    np.testing.assert_array_equal(rows.pose[:, 1, 2], 0.0995)
