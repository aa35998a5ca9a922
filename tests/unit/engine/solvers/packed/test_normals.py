"""Packed rows of a normal alone obey mechanics worked out without them."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, box, plane, planned, resolved, sphere
from packed_drawn import drawn, packed_solver, with_rows

from lavendersim.engine.solvers.packed.late import FEWEST_CONTACTS, FIRST
from tests.benchmarks.prepared_contacts import Solve

G, DT = 9.81, 1.0 / 240.0


@pytest.mark.parametrize("eight", [False, True])
def test_velocities_carry_the_impulses_about_every_axis(eight: bool) -> None:
    """M (v - v_0) = sum of impulses, and I (omega - omega_0) that of their moments, from poses.

    A hundred roundings a visit, times the visits; impulses of some 10 N s on 0.5 kg and more.
    """
    prepared = drawn(1, frictional=False)
    spec = with_rows("frictionless", "levers").without("newton")._replace(shape_pairs=())
    solve = Solve(prepared._replace(spec=spec), packed_solver(eight))
    solve.run(20)
    bodies, before = prepared.bodies, prepared.velocities
    given = solve.contacts["lambda_n"] - prepared.contacts["lambda_n"]
    assert np.abs(given).max() > 0.01
    expected_v = np.stack([before[f"v{axis}"] for axis in "xyz"], axis=1)
    expected_w = np.stack([before[f"w{axis}"] for axis in "xyz"], axis=1)
    for contact, impulse in zip(prepared.contacts, given, strict=True):
        point = np.array([contact[axis] for axis in "xyz"])
        push = impulse * np.array([contact[f"n{axis}"] for axis in "xyz"])
        for sign, i in ((-1.0, contact["a"]), (1.0, contact["b"])):
            body = bodies[i]
            turn = np.array([[body[f"r{r}{c}"] for c in range(3)] for r in range(3)])
            inverse = turn @ np.diag([body[f"inv_i{axis}"] for axis in "xyz"]) @ turn.T
            arm = point - [body[axis] for axis in "xyz"]
            expected_v[i] += sign * body["inv_m"] * push
            expected_w[i] += sign * inverse @ np.cross(arm, push)
    allowed = 2.0**-53 * 100 * 20 * 100
    for k, axis in enumerate("xyz"):
        np.testing.assert_allclose(solve.velocities[f"v{axis}"], expected_v[:, k], atol=allowed)
        np.testing.assert_allclose(
            solve.velocities[f"w{axis}"], expected_w[:, k], atol=10 * allowed
        )


def _settling(packs: bool, shape: str) -> Bench:
    """Return two hundred columns of two bodies on frictionless ground, one step made, cold."""
    bodies = {"floor": plane()}
    for k in range(200):
        for j, mass in enumerate((4.0, 1.0)):
            place = (0.5 * k, 0.0, 0.1 + 0.2 * j)
            if shape == "sphere":
                bodies[f"body_{k}_{j}"] = sphere(0.1, place, mass=mass)
            else:
                bodies[f"body_{k}_{j}"] = box((0.2, 0.2, 0.2), place, mass=mass)
    cell = resolved(bodies, (0.0, 0.0, -G), solver="adaptive", sweeps=200, warm_start=False)
    spec = planned(cell).spec.without("packed_sweeps", "newton", "least_norm", "supernodes")
    bench = Bench(cell, spec.including("packed_sweeps") if packs else spec)
    bench.run(1)
    return bench


@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_columns_on_smooth_ground_are_carried_by_their_weight(shape: str) -> None:
    """Cold, the sweeps carry 5 m g dt to the floor: a share of 1/5 of the error stays a sweep.

    200 sweeps leave round-off: of 0.2 N s, a hundred roundings a visit.
    """
    bench = _settling(True, shape)
    counters, count = bench.engine.counters[0], int(bench.engine.counters["contacts"][0])
    assert count >= FEWEST_CONTACTS
    assert counters["sweeps"] > FIRST
    contacts = bench.engine.contacts[:count]
    on_floor = contacts["a"] == 0
    corners = 1 if shape == "sphere" else 4
    for rows, load in ((on_floor, 5.0), (~on_floor, 1.0)):
        of_body = np.zeros(len(bench.engine.bodies))
        np.add.at(of_body, contacts["b"][rows].astype(int), contacts["lambda_n"][rows])
        pushed = of_body[of_body > 0.0]
        assert len(pushed) == 200
        assert np.count_nonzero(rows) == corners * 200
        np.testing.assert_allclose(pushed, load * G * DT, rtol=0, atol=2.0**-53 * 100 * 100)
    np.testing.assert_allclose(bench.velocity, 0.0, atol=2.0**-53 * 100 * 100)
