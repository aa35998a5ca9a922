"""Positional projection moves poses and adds no velocity.

With slop s and share p, one free-falling contact at rest is moved by p (d - s) in a step.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import drawn, put_vector
from interpreted import interpreted, records
from laboratory import Bench, box, plane, resolved, sphere
from plain_facts import one_row

from lavendersim.engine.effects.projection import make, make_moves_by_mean
from lavendersim.engine.integrate import AFTERWARDS, ALWAYS, LASTING
from lavendersim.engine.record_layout import allocate_velocities
from lavendersim.engine.records import MOTION, dtype
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

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


CENTRED = Spec(
    ("contact_midpoint", "friction", "impact_time", "midpoint", "projection", "rotation"),
    ("sphere_plane", "sphere_sphere"),
)
DT, SLOP, SHARE = 0.004, 1e-5, 0.2


def correction(carried: int, begin: float, end: float, bend: float, phi: float, dv: float) -> float:
    """Return what is asked of a contact that does not push: n.v goes from begin to end [m/s]."""
    scene = drawn(CENTRED, np.random.default_rng(3), [(0, 1)])
    row, velocities = scene.contacts[0], allocate_velocities(CENTRED, 2)
    normal = np.array([row[f"n{x}"] for x in "xyz"])
    put_vector(velocities[1], "v", end * normal)
    motion = np.zeros(2, dtype(MOTION))
    motion["carried"], motion["tau"] = carried, DT
    values = {"phi": phi, "dv_n": dv, "begin_n": begin, "middle_n": begin + bend}
    for name, value in (values | {"lambda_n": 0.0, "lasts": 0}).items():
        row[name] = value
    params = one_row(dt=DT, timestep=DT, slop=SLOP, projection=SHARE, projection_sweeps=3)
    order = np.zeros(1, np.int64)
    system: Any = ContactSystem(
        records(scene.contacts), order, 1, records(scene.bodies), records(velocities)
    )
    pseudo = records(allocate_velocities(CENTRED, 2))
    interpreted(make(CENTRED))(system, records(motion), pseudo, None, params)
    return float(row["correction"])


def test_what_another_contact_carries_by_its_mean_is_not_moved_for_where_its_end_leads() -> None:
    """A rim that comes down as the step ends, and rose as it began, is where it was.

    The gap at the end is phi + dt ((v_0 + v_1)/2 + bend), see `widen`.
    """
    for bend in (0.0, 0.05, -0.05):
        for deep in (-2.0 * SLOP, 0.5 * SLOP, 3.0 * SLOP):
            phi = -deep - DT * bend
            found = correction(LASTING, 1.0, -1.0, bend, phi, -0.04)
            assert found == pytest.approx(SHARE * max(deep - SLOP, 0.0), abs=1e-16)
            assert correction(LASTING, 1.5, -1.0, bend, phi - 0.25 * DT, -0.04) == pytest.approx(
                found, abs=1e-16
            )


def test_what_flies_is_where_forces_let_it_be() -> None:
    """v_1 - dv/2: no other contact changed its velocity."""
    deep, dv = 3.0 * SLOP, -0.04
    phi = -deep - DT * (-1.0 - 0.5 * dv)
    for carried in (0, ALWAYS):
        found = correction(carried, -1.0 - dv, -1.0, 0.0, phi, dv)
        assert found == pytest.approx(SHARE * (deep - SLOP), abs=1e-16)


def test_a_row_moves_by_the_mean_of_its_bodies_where_one_is_carried_by_it_and_none_jumps() -> None:
    kernel = interpreted(make_moves_by_mean(CENTRED))

    def carried(a: int, b: int) -> bool:
        motion = np.zeros(2, dtype(MOTION))
        motion["carried"] = a, b
        return bool(kernel(*records(motion)))

    for pair in ((LASTING, LASTING), (LASTING, 0), (0, LASTING)):
        assert carried(*pair)
    assert not carried(0, 0)
    for other in (ALWAYS, AFTERWARDS):
        assert not carried(LASTING, other)
        assert not carried(other, LASTING)
