"""Rotation: the turn is Cayley's map, free bodies keep their angular momentum.

Cayley: a turn by the vector a [rad] is a rotation about a by 2 atan(|a| / 2).
"""

from __future__ import annotations

import convex
import numpy as np
import pytest
from laboratory import Bench, box, resolved

SIZE = (1.0, 0.5, 0.2)


def tumbling(timestep, duration, spin=(0.1, 5.0, 0.2)):
    """A free box spun about its unstable middle axis; rows at every step."""
    bodies = {"box": box(SIZE, (0.0, 0.0, 0.0), mass=2.0, angular_velocity=spin)}
    bench = Bench(resolved(bodies, timestep=f"1/{timestep}"))
    return bench.run(round(duration * timestep))


@pytest.mark.parametrize("angle", [1e-6, 0.1, 1.0, 3.0])
def test_a_free_cube_turns_by_cayleys_map(angle):
    axis = np.array([0.6, 0.0, 0.8])
    spin = angle * 240.0 * axis
    start = np.array([0.5, 0.5, -0.5, 0.5])
    bodies = {"cube": box((1, 1, 1), (0, 0, 0), angular_velocity=spin, orientation=start)}
    pose = Bench(resolved(bodies)).run(1).pose[-1, 0, 3:]
    half = np.arctan(0.5 * angle)
    turn = convex.matrix_of(np.array([np.cos(half), *(np.sin(half) * axis)]))
    np.testing.assert_allclose(convex.matrix_of(pose), turn @ convex.matrix_of(start), atol=1e-15)
    assert np.linalg.norm(pose) == pytest.approx(1.0, abs=3e-16)


def test_angular_momentum_of_a_tumbling_box_is_kept_to_round_off():
    step = tumbling(240, 10.0).step
    momentum = np.column_stack([step[f"angular_momentum_{k}"] for k in "xyz"])
    size = np.linalg.norm(momentum[0])
    # Each of 2400 steps rounds L through I^-1 and I once: a walk of some 1e-16.
    assert np.abs(momentum - momentum[0]).max() < 2400 * 3e-16 * size


def test_energy_error_of_a_tumbling_box_is_second_order():
    """Halving dt quarters the largest error; 3.2 leaves room for the next order."""
    errors = []
    for timestep in (120, 240, 480, 960):
        energy = tumbling(timestep, 3.0).step["kinetic_energy"]
        errors.append(np.abs(energy - energy[0]).max() / energy[0])
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    assert (ratios > 3.2).all(), errors
    assert errors[1] < 1e-3


def test_a_box_spun_about_its_middle_axis_flips_over():
    """Dzhanibekov's flip: the body's middle axis reverses against its fixed momentum."""
    pose = tumbling(240, 10.0).pose[:, 0, 3:]
    along = [convex.matrix_of(q)[1, 1] for q in pose[::10]]
    assert min(along) < -0.9
    assert max(along[len(along) // 4 :]) > 0.9


def test_spin_about_a_principal_axis_stays():
    step = tumbling(240, 2.0, spin=(0.0, 0.0, 7.0)).step
    inertia = 2.0 / 12.0 * (1.0 + 0.25)
    np.testing.assert_allclose(step["angular_momentum_z"], 7.0 * inertia, rtol=1e-12)
    np.testing.assert_allclose(step["kinetic_energy"], 0.5 * inertia * 49.0, rtol=1e-12)
