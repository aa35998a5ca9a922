"""Rotation: the turn is Cayley's map; free bodies keep angular momentum and energy.

Cayley: a turn by the vector a [rad] is a rotation about a by 2 atan(|a| / 2).
"""

from __future__ import annotations

import convex
import numpy as np
import pytest
from laboratory import Bench, box, resolved

from lavendersim.engine.records import DIVERGED, TURNS_TOO_FAST

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


@pytest.mark.parametrize("size", [SIZE, (10.0, 1e-3, 2e-3), (3.0, 1.0, 1e-3)])
@pytest.mark.parametrize("spin", [(0.1, 5.0, 0.2), (1.0, 2.0, 3.0), (100.0, 20.0, 30.0)])
def test_free_bodies_keep_angular_momentum_and_energy_to_round_off(size, spin):
    """Boxes, needles and plates. 2400 steps of some 50 roundings each walk 1e-14; 1e-12 is ample.

    A needle's spin about its own axis is its momentum there over an inertia 1e8 times smaller: a
    scheme that lets a truncation error into that component makes energy without end.
    """
    bodies = {"body": box(size, (0.0, 0.0, 0.0), mass=2.0, angular_velocity=spin)}
    step = Bench(resolved(bodies)).run(2400).step
    momentum = np.column_stack([step[f"angular_momentum_{k}"] for k in "xyz"])
    error = np.abs(momentum - momentum[0]).max()
    assert error < 1e-12 * np.linalg.norm(momentum[0])
    np.testing.assert_allclose(step["kinetic_energy"], step["kinetic_energy"][0], rtol=1e-12)


def test_orientation_error_of_a_tumbling_box_is_second_order():
    """Halving dt quarters the error after 1 s; 3.6 leaves room for the next order."""
    reference = tumbling(15360, 1.0).pose[-1, 0, 3:]
    errors = []
    for timestep in (120, 240, 480, 960):
        final = tumbling(timestep, 1.0).pose[-1, 0, 3:]
        errors.append(min(np.abs(final - reference).max(), np.abs(final + reference).max()))
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    assert (ratios > 3.6).all(), errors
    assert errors[1] < 1e-2


def test_a_spin_too_fast_for_its_timestep_ends_the_run_and_makes_no_energy():
    """2000 rad/s at 240 Hz are 8 rad a step: no midpoint need exist, and the run says so."""
    bodies = {
        "slow": box(SIZE, (5.0, 0.0, 0.0), angular_velocity=(1.0, 2.0, 0.1)),
        "body": box(SIZE, (0.0, 0.0, 0.0), angular_velocity=(1000.0, 2000.0, 10.0)),
    }
    bench = Bench(resolved(bodies))
    energy = bench.run(2400).step["kinetic_energy"]
    assert bench.status == DIVERGED
    assert bench.engine.counters["cause"][0] == TURNS_TOO_FAST
    assert bench.engine.counters["body"][0] == 1
    np.testing.assert_allclose(energy, energy[0], rtol=1e-12)


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
