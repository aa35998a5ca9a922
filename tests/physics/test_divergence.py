"""A state that is no longer finite stops the run at that step and names its body."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, resolved, sphere

from lavendersim.engine.records import DIVERGED


def bench_of_three():
    bodies = {
        "floor": plane(),
        "still": sphere(0.1, (0.0, 0.0, 5.0)),
        "box": box((0.2, 0.2, 0.2), (2.0, 0.0, 0.1)),
        "wild": box((0.2, 0.3, 0.2), (4.0, 0.0, 3.0)),
    }
    return Bench(resolved(bodies, (0.0, 0.0, -9.81)))


SPEEDS = ("vx", "vy", "vz", "wx", "wy", "wz")


# A finite component of a quaternion, however large, is made part of a unit one.
@pytest.mark.parametrize(
    ("table", "field", "value"),
    [
        *(("velocities", speed, value) for speed in SPEEDS for value in (np.inf, np.nan, 1e160)),
        *(("velocities", speed, -np.inf) for speed in ("vx", "wz")),
        *(("bodies", place, value) for place in "xyz" for value in (np.inf, np.nan)),
        *(("bodies", "qw", value) for value in (np.inf, -np.inf, np.nan)),
    ],
)
def test_the_body_that_left_the_finite_is_named_in_that_step(table, field, value):
    bench = bench_of_three()
    bench.run(3)
    getattr(bench.engine, table)[field][3] = value
    rows = bench.run(5)
    assert bench.status == DIVERGED
    assert bench.engine.counters["body"][0] == 3
    assert list(rows.step["step"]) == [4]


def test_a_body_in_contact_that_diverges_is_not_hidden_by_its_contacts():
    """A projection onto [0, inf) written the wrong way round turns NaN into no impulse at all."""
    bench = bench_of_three()
    bench.run(3)
    bench.engine.velocities["vz"][2] = np.nan
    rows = bench.run(1)
    assert bench.status == DIVERGED
    assert bench.engine.counters["body"][0] == 2
    assert np.isnan(rows.step["residual"][-1])
    assert np.isnan(rows.contact["residual"]).any()


def test_a_huge_but_finite_scene_does_not_stop():
    bodies = {
        "floor": plane(),
        "ball": sphere(1.0, (1e5, -1e5, 1.0), mass=1e9, velocity=(1e3, 0.0, -1e3)),
    }
    bench = Bench(resolved(bodies, (0.0, 0.0, -9.81)))
    rows = bench.run(50)
    assert bench.status != DIVERGED
    assert np.isfinite(rows.pose).all()


@pytest.mark.parametrize("ratio", [1e-9, 1e9])
def test_masses_far_apart_stay_finite_and_bounded(ratio):
    """Two boxes on each other, either a billion times heavier: poor accuracy is no explosion.

    22 sweeps leave the pair falling; what they may not do is make energy.
    """
    bodies = {
        "floor": plane(),
        "low": box((0.5, 0.5, 0.5), (0.0, 0.0, 0.25), mass=1.0),
        "high": box((0.4, 0.4, 0.4), (0.05, 0.0, 0.7), mass=ratio),
    }
    numerics = {"stabilisation_gain": 0.02, "projection": 0.2, "slop": 0.001}
    bench = Bench(resolved(bodies, (0.0, 0.0, -9.81), **numerics))
    rows = bench.run(24)
    assert bench.status != DIVERGED
    assert np.isfinite(rows.contact["impulse_n"]).all()
    energy = rows.step["kinetic_energy"] + rows.step["potential_energy"]
    assert energy.max() <= energy[0] * (1.0 + 1e-9)


@pytest.mark.parametrize("gap", [0.0, 0.2, 0.4])
def test_deep_overlap_is_pushed_out_without_a_launch(gap):
    """Bias gives at most beta d / dt = 0.02 * 0.5 * 240 = 2.4 m/s of separation."""
    bodies = {
        "a": box((0.5, 0.5, 0.5), (0.0, 0.0, 0.0)),
        "b": box((0.5, 0.5, 0.5), (gap, 0.0, 0.0)),
    }
    bench = Bench(resolved(bodies, stabilisation_gain=0.02, projection=0.2, slop=0.001))
    rows = bench.run(120)
    assert bench.status != DIVERGED
    assert np.abs(bench.velocity).max() <= 2.4
    assert rows.step["max_penetration"][-1] <= 0.001 + 1e-9
