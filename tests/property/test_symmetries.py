"""Physics does not depend on the observer: a moving frame, a turned frame, a shifted origin.

Trajectories of contacts diverge from each other exponentially, so runs are short: round-off of
1e-16 may grow a thousandfold in ten steps with contacts and stays far below 1e-9.
"""

from __future__ import annotations

import copy

import convex
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from worlds import FEW, clusters, run, vector

STEPS = 20
NUMERICS = {"stabilisation_gain": 0.02, "projection": 0.2, "slop": 0.001}


def moved(bodies, **changes):
    """A copy in which each named vector of every body is replaced by changes[name](vector)."""
    copied = copy.deepcopy(bodies)
    for described in copied.values():
        for name, change in changes.items():
            described[name] = list(change(np.array(described[name])))
    return copied


@given(clusters(restitution=True, friction=True), vector)
@FEW
def test_a_moving_observer_sees_the_same_motion(bodies, direction):
    speed = 3.0 * np.array(direction)
    _, still = run(bodies, STEPS, **NUMERICS)
    _, seen = run(moved(bodies, velocity=lambda v: v + speed), STEPS, **NUMERICS)
    shift = speed * np.arange(STEPS + 1)[:, None, None] / 240.0
    np.testing.assert_allclose(seen.pose[:, :, :3] - shift, still.pose[:, :, :3], atol=1e-9)
    np.testing.assert_allclose(seen.contact["impulse_n"], still.contact["impulse_n"], atol=1e-9)


@given(clusters(restitution=True, friction=True), st.floats(-3.0, 3.0, width=32))
@FEW
def test_the_world_turned_about_gravity_moves_turned(bodies, angle):
    gravity = (0.0, 0.0, -9.81)
    quaternion = np.array([np.cos(0.5 * angle), 0.0, 0.0, np.sin(0.5 * angle)])
    matrix = convex.matrix_of(quaternion)

    def turned(vector):
        return matrix @ vector

    def turned_quaternion(q):
        w, x, y, z = q
        c, s = quaternion[0], quaternion[3]
        return np.array([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w])

    changes = dict.fromkeys(("position", "velocity", "angular_velocity"), turned)
    other = moved(bodies, **changes, orientation=turned_quaternion)
    _, plain = run(bodies, STEPS, gravity, **NUMERICS)
    _, seen = run(other, STEPS, gravity, **NUMERICS)
    np.testing.assert_allclose(seen.pose[:, :, :3], plain.pose[:, :, :3] @ matrix.T, atol=1e-9)


@given(clusters(restitution=True, friction=True), st.integers(-8, 8))
@FEW
def test_masses_times_a_power_of_two_scale_impulses_and_nothing_else(bodies, exponent):
    """Times 2^k nothing is rounded differently: positions are bit-equal, impulses exactly 2^k."""
    heavier = copy.deepcopy(bodies)
    for described in heavier.values():
        described["mass"] *= 2.0**exponent
        described["inertia"] = [moment * 2.0**exponent for moment in described["inertia"]]
    _, plain = run(bodies, STEPS, **NUMERICS)
    _, scaled = run(heavier, STEPS, **NUMERICS)
    np.testing.assert_array_equal(scaled.pose, plain.pose)
    impulses = plain.contact["impulse_n"] * 2.0**exponent
    np.testing.assert_array_equal(scaled.contact["impulse_n"], impulses)


@given(clusters(restitution=True, friction=True))
@FEW
def test_equal_worlds_are_equal_to_the_last_bit(bodies):
    _, one = run(bodies, STEPS, **NUMERICS)
    _, other = run(copy.deepcopy(bodies), STEPS, **NUMERICS)
    for found, wanted in zip(one, other, strict=True):
        assert found.tobytes() == wanted.tobytes()
