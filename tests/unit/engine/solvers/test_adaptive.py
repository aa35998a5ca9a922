"""The residual is the natural map of the logged rows, and many sweeps reach the true solution.

The truth comes from an independent assembly of W and q and from trying every set of pushing rows.
"""

from __future__ import annotations

import numpy as np
import pytest
from complementarity import natural_map, solve_by_enumeration
from laboratory import Bench, box, plane, planned, resolved, sphere
from rows import RowOracle

GRAVITY = (0.0, 0.0, -9.81)
NUMERICS = {"stabilisation_gain": 0.02, "slop": 0.001}

SCENES = {
    "tilted box lands": {
        "floor": plane(restitution=0.4),
        "box": box(
            (1.0, 0.6, 0.4),
            (0.0, 0.0, 0.199),
            mass=3.0,
            velocity=(0.1, 0.0, -1.0),
            angular_velocity=(0.5, -0.7, 0.2),
        ),
    },
    "box hits box at rest": {
        "floor": plane(),
        "low": box((1.0, 1.0, 0.4), (0.0, 0.0, 0.2), mass=5.0),
        "high": box((0.5, 0.5, 0.5), (0.2, 0.1, 0.648), velocity=(0.0, 0.0, -2.0), restitution=0.5),
    },
    "chain of spheres": {
        "wall": plane((1.0, 0.0, 0.0), 0.0),
        "s1": sphere(0.1, (0.1, 0.0, 0.0), mass=1.0),
        "s2": sphere(0.1, (0.3, 0.01, 0.0), mass=10.0),
        "s3": sphere(0.1, (0.49, 0.0, 0.02), mass=0.3, velocity=(-1.0, 0.0, 0.0), restitution=0.9),
    },
    "compliant box": {
        "floor": plane(compliance=1e-5),
        "box": box((1.0, 0.6, 0.4), (0.0, 0.0, 0.19), mass=3.0, velocity=(0.0, 0.0, -1.0)),
    },
    "compliant and hard": {
        "floor": plane(),
        "low": box((1.0, 1.0, 0.4), (0.0, 0.0, 0.199), mass=5.0),
        "ball": sphere(0.1, (0.3, 0.2, 0.498), compliance=1e-6, velocity=(0.0, 0.0, -3.0)),
    },
}


def one_step(name, sweeps, tolerance=None):
    # A config has a sweep at least; an engine takes none, too.
    numerics = {**NUMERICS, "sweeps": max(sweeps, 1), "tolerance": tolerance}
    bench = Bench(resolved(SCENES[name], GRAVITY, **numerics))
    bench.engine.parameters["sweeps"] = sweeps
    oracle = RowOracle(bench)
    return oracle, bench.run(1)


@pytest.mark.parametrize("sweeps", [0, 1, 3, 22])
@pytest.mark.parametrize("name", SCENES)
def test_logged_residuals_equal_an_independent_natural_map(name, sweeps):
    oracle, rows = one_step(name, sweeps)
    contacts = rows.contact
    matrix, q = oracle.problem(contacts)
    gamma = oracle.gamma(contacts)
    w = matrix @ contacts["impulse_n"] + q
    expected = natural_map(contacts["impulse_n"], w, np.diag(matrix))
    # Speeds of some m/s and a hundred roundings; a compliant row multiplies by gamma / k.
    scale = 1e-13 * max(1.0, float(np.max(gamma)))
    np.testing.assert_allclose(contacts["residual"], expected, atol=scale)
    step = rows.step[-1]
    assert step["residual"] == contacts["residual"].max()
    assert contacts["residual"][step["residual_contact"]] == step["residual"]
    assert rows.residual["residual"][-1] == step["residual"]


@pytest.mark.parametrize("name", SCENES)
def test_approach_velocities_are_those_before_the_solve(name):
    oracle, rows = one_step(name, 22)
    expected = oracle.approach(rows.contact)
    np.testing.assert_allclose(rows.contact["approach_velocity"], expected, atol=1e-13)


@pytest.mark.parametrize("name", SCENES)
def test_many_sweeps_reach_the_velocities_of_the_true_solution(name):
    oracle, rows = one_step(name, 20000)
    contacts = rows.contact
    matrix, q = oracle.problem(contacts)
    impulse = solve_by_enumeration(matrix, q)
    expected = oracle.approach(contacts) + oracle.delassus(contacts) @ impulse
    # Sweeps stall at round-off of impulses; W's condition is below 1e3 here.
    np.testing.assert_allclose(contacts["normal_velocity"], expected, atol=1e-10)
    assert rows.step[-1]["residual"] < 1e-10


def test_residuals_of_sweeps_are_numbered_from_zero_and_end_with_the_step():
    _, rows = one_step("tilted box lands", 7)
    np.testing.assert_array_equal(rows.residual["sweep"], np.arange(8))
    np.testing.assert_array_equal(rows.residual["step"], 1)
    assert rows.residual["residual"][0] > rows.residual["residual"][-1]


def test_a_tolerance_stops_early_and_says_after_how_many_sweeps():
    _, full = one_step("box hits box at rest", 300)
    curve = full.residual["residual"]
    for tolerance in (1e-1, 1e-3, 1e-6):
        needed = int(np.argmax(curve <= tolerance))
        _, rows = one_step("box hits box at rest", 300, tolerance)
        assert 0 < needed < 300
        assert rows.step[-1]["sweeps"] == needed
        assert rows.step[-1]["residual"] == curve[needed]
        assert len(rows.residual) == needed + 1


def test_without_a_tolerance_every_sweep_is_made():
    _, rows = one_step("chain of spheres", 31)
    assert rows.step[-1]["sweeps"] == 31


def test_sweeps_end_when_one_changes_nothing_and_the_bits_are_those_of_all_sweeps():
    """With residuals recorded every sweep is made; without, a fixed point ends the solve."""
    bodies = {"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.0995))}
    cell, steps = resolved(bodies, GRAVITY), 300
    spec = planned(cell).spec.including("residual_log")
    every = Bench(cell, spec).run(steps)
    fewer = Bench(cell, spec.without("residual_log")).run(steps)
    assert (every.step["sweeps"][1:] == 22).all()
    # one row is solved by the first sweep; the second or third finds nothing left to round
    assert fewer.step["sweeps"][-1] <= 3
    np.testing.assert_array_equal(every.step["state_hash"], fewer.step["state_hash"])
    np.testing.assert_array_equal(every.contact["impulse_n"], fewer.contact["impulse_n"])
