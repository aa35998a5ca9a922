"""Impulses are carried over by contacts that persist, scaled by the timestep, and by nothing else.

No sweeps are made (`sweeps = 0`), so a logged impulse is exactly what the cache handed on.
"""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, planned, resolved, sphere

GRAVITY = (0.0, 0.0, -9.81)


def settled(bodies, **numerics):
    """A bench after one fully solved step, and its impulses; the next steps do no sweeps."""
    bench = Bench(resolved(bodies, GRAVITY, sweeps=200, **numerics))
    impulses = bench.run(1).contact["impulse_n"].copy()
    bench.engine.parameters["sweeps"] = 0
    for row in bench.engine.velocities:
        row["vx"] = row["vy"] = row["vz"] = 0.0
    return bench, impulses


def ball(**properties):
    return {"floor": plane(), "ball": sphere(0.1, (0.0, 0.0, 0.1), **properties)}


def block():
    return {"floor": plane(), "block": box((1.0, 1.0, 1.0), (0.0, 0.0, 0.5))}


def test_a_contact_that_persists_starts_at_its_impulse():
    bench, impulses = settled(block())
    assert impulses.sum() == pytest.approx(9.81 / 240.0, rel=1e-12)
    np.testing.assert_array_equal(bench.run(1).contact["impulse_n"], impulses)


@pytest.mark.parametrize("ratio", [0.5, 2.0, 3.0])
def test_impulses_scale_with_the_timestep(ratio):
    bench, impulses = settled(block())
    bench.engine.parameters["dt"] *= ratio
    found = bench.run(1).contact["impulse_n"]
    # dt/dt_cached is one division and one product.
    np.testing.assert_allclose(found, impulses * ratio, rtol=3e-16)
    # The next step's cache belongs to the new timestep: no second scaling.
    bench.engine.velocities["vz"] = 0.0
    np.testing.assert_array_equal(bench.run(1).contact["impulse_n"], found)


@pytest.mark.parametrize(("share", "kept"), [(0.99, True), (1.01, False)])
def test_a_contact_point_beyond_the_cache_distance_starts_from_zero(share, kept):
    bench, impulses = settled(ball())
    bench.engine.bodies["x"][1] += 0.02 * share
    found = bench.run(1).contact["impulse_n"]
    assert found[0] == (impulses[0] if kept else 0.0)


@pytest.mark.parametrize(("share", "kept"), [(0.99, True), (1.01, False)])
def test_a_normal_that_turned_beyond_the_cosine_starts_from_zero(share, kept):
    """The sphere rolls about another's surface: n turns by the angle, the point by 2 mm at most."""
    angle = share * np.arccos(0.95)
    bodies = {
        "fixed": sphere(0.004, (0.0, 0.0, 0.0), fixed=True),
        "ball": sphere(0.006, (0.0, 0.0, 0.01)),
    }
    bench, impulses = settled(bodies)
    bench.engine.bodies["x"][1] = 0.00999 * np.sin(angle)
    bench.engine.bodies["z"][1] = 0.00999 * np.cos(angle)
    found = bench.run(1).contact["impulse_n"]
    assert impulses[0] > 0.0
    assert found[0] == (impulses[0] if kept else 0.0)


def test_a_forgotten_body_starts_from_zero_and_the_others_do_not():
    bodies = {
        "floor": plane(),
        "left": sphere(0.1, (0.0, 0.0, 0.1)),
        "right": sphere(0.1, (1.0, 0.0, 0.1), mass=2.0),
        "top": sphere(0.1, (1.0, 0.0, 0.3)),
    }
    bench, impulses = settled(bodies)
    bench.engine.forget_contacts(1)
    found = bench.run(1).contact
    expected = np.where(found["body_b"] == 1, 0.0, impulses)
    np.testing.assert_array_equal(found["impulse_n"], expected)
    assert (expected > 0.0).sum() == 2


def test_forgetting_everything_starts_everything_from_zero():
    bench, _ = settled(block())
    bench.engine.forget_contacts()
    np.testing.assert_array_equal(bench.run(1).contact["impulse_n"], 0.0)


def test_a_contact_that_was_lost_for_a_step_injects_nothing_stale():
    bench, _ = settled(ball())
    bench.engine.bodies["z"][1] = 0.5
    assert len(bench.run(1).contact) == 0
    bench.engine.bodies["z"][1] = 0.1
    bench.engine.velocities["vz"] = 0.0
    assert bench.run(1).contact["impulse_n"][0] == 0.0


def test_a_cold_cell_stays_cold_in_an_engine_that_it_shares_with_warm_ones():
    cell = resolved(ball(), GRAVITY, warm_start=False)
    assert not planned(cell).spec.has("warm_start")
    bench = Bench(cell)
    assert bench.spec.has("warm_start")
    bench.run(1)
    bench.engine.parameters["sweeps"] = 0
    assert bench.run(1).contact["impulse_n"][0] == 0.0


def test_a_new_point_does_not_take_the_impulse_of_one_that_persists():
    """Two corners of a small box share a cache distance. The cache holds corner 1 alone; corner 0,
    visited first and within reach, is new: the impulse belongs to corner 1."""
    bodies = {"floor": plane(), "block": box((0.01, 0.01, 0.01), (0.0, 0.0, 0.005))}
    bench, impulses = settled(bodies)
    cache = bench.engine.state.cache
    kept = cache[cache["feature"] == 1].copy()
    cache[:1] = kept
    bench.engine.counters["cached"] = 1
    found = bench.run(1).contact
    np.testing.assert_array_equal(
        found["impulse_n"], np.where(found["feature"] == 1, kept["lambda_n"][0], 0.0)
    )
    assert impulses.min() > 0.0


def test_no_impulse_is_handed_on_twice():
    """All features renamed: four points find the four nearest, one each."""
    bench, impulses = settled(block())
    bench.engine.state.cache["feature"] += 100
    np.testing.assert_array_equal(bench.run(1).contact["impulse_n"], impulses)
    one_left, _ = settled({"floor": plane(), "block": box((0.01, 0.01, 0.01), (0.0, 0.0, 0.005))})
    one_left.engine.state.cache["feature"] += 100
    one_left.engine.counters["cached"] = 1
    assert np.count_nonzero(one_left.run(1).contact["impulse_n"]) == 1


def test_a_pair_that_loses_its_friction_starts_without_any():
    """A sliding ball; an event takes the friction of its pair, torsional and rolling as well.

    A frictionless row has no tangential impulse and no torque: what began with one logged it, and
    nothing of it acted (`tests/property/fuzz.py`, two runs in 2,400 of a drawn plan).
    """
    kinds = ("friction", "torsional_friction", "rolling_friction")
    spun = {"velocity": (1.0, 0.0, 0.0), "angular_velocity": (1.0, 3.0, 2.0)}
    surface = dict.fromkeys(kinds, 0.1)
    bodies = {"floor": plane(**surface), "ball": sphere(0.1, (0.0, 0.0, 0.1), **surface, **spun)}
    bench = Bench(resolved(bodies, GRAVITY))
    columns = ("impulse_t1", "angular_impulse_n", "angular_impulse_t1")
    began = bench.run(1).contact[0]
    assert all(abs(began[column]) > 1e-5 for column in columns)
    for kind in kinds:
        bench.engine.state.pairs[kind] = 0.0
    speed = bench.velocity[1, 0]
    after = bench.run(1).contact[0]
    assert after["impulse_n"] > 0.0
    assert [after[column] for column in columns] == [0.0, 0.0, 0.0]
    assert bench.velocity[1, 0] == speed


@pytest.mark.parametrize("taken", ["torsional_friction", "rolling_friction"])
def test_a_pair_that_loses_one_friction_of_turning_starts_without_its_torque(taken):
    """No sweep changes a torque whose coefficient is 0: what is handed on would act for ever.

    Runs 221 of `python tests/property/fuzz.py --plans 18 --seed 11 --only plan_1`, 6 and 93 of
    `plan_2`.
    """
    column = {"torsional_friction": "angular_impulse_n", "rolling_friction": "angular_impulse_t1"}
    spun = {"velocity": (1.0, 0.0, 0.0), "angular_velocity": (1.0, 3.0, 2.0)}
    surface = dict.fromkeys(("friction", *column), 0.1)
    bodies = {"floor": plane(**surface), "ball": sphere(0.1, (0.0, 0.0, 0.1), **surface, **spun)}
    bench = Bench(resolved(bodies, GRAVITY))
    began = bench.run(1).contact[0]
    bench.engine.state.pairs[taken] = 0.0
    after = bench.run(1).contact[0]
    for kind, name in column.items():
        assert abs(began[name]) > 1e-5
        assert (after[name] == 0.0) == (kind == taken)
