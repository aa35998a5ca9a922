"""Bodies fall asleep at the speed of their fastest point, and wake with the masses they had."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from drawn_contacts import put_vector
from interpreted import interpreted, records
from plain_facts import one_row

from lavendersim.engine.effects.sleeping import (
    make_measure_speeds,
    make_update_sleeping,
    make_wake_island,
)
from lavendersim.engine.record_layout import allocate_bodies, allocate_velocities, contact_dtype
from lavendersim.engine.spec import Spec

SPEC = Spec(("contact_torque", "rotation", "sleeping"), ("box_plane",))
INVERSE = ("inv_m", "inv_ix", "inv_iy", "inv_iz")


def test_the_speed_of_a_body_is_the_most_that_a_point_of_it_may_have(rng) -> None:
    """|v| + R |w|."""
    bodies, velocities = allocate_bodies(SPEC, 3), allocate_velocities(SPEC, 3)
    bodies["bound"] = rng.uniform(0.1, 2.0, 3)
    v, w = rng.normal(size=(2, 3, 3))
    for row, own, spin in zip(velocities, v, w, strict=True):
        put_vector(row, "v", own)
        put_vector(row, "w", spin)
    interpreted(make_measure_speeds(SPEC))(records(bodies), records(velocities))
    expected = np.linalg.norm(v, axis=1) + bodies["bound"] * np.linalg.norm(w, axis=1)
    np.testing.assert_allclose(bodies["point_speed"], expected, rtol=1e-14)


def test_who_wakes_has_the_mass_and_the_moments_with_which_it_fell_asleep(rng) -> None:
    bodies, velocities = allocate_bodies(SPEC, 2), allocate_velocities(SPEC, 2)
    for name in INVERSE:
        bodies[name] = rng.uniform(0.3, 3.0, 2)
    velocities["vx"], velocities["wy"] = 1e-6, 1e-6
    before, still = bodies[list(INVERSE)].copy(), dict.fromkeys(INVERSE, 0.0)
    bodies["rest"], bodies["point_speed"] = [9.0, 0.0], [0.0, 1.0]
    state = SimpleNamespace(
        **{"bodies": records(bodies), "velocities": records(velocities), "motion": None},
        contacts=records(np.zeros(0, contact_dtype(SPEC))),
    )
    params = one_row(sleep_speed=0.1, sleep_time=1.0, dt=0.01)
    island = np.zeros(2, np.int64)
    interpreted(make_update_sleeping(SPEC))(state, 0, island, params)
    assert bodies["asleep"].tolist() == [1, 0]
    assert {name: bodies[name][0] for name in INVERSE} == still
    assert not any(velocities[name][0] for name in velocities.dtype.names)
    interpreted(make_wake_island(SPEC))(records(bodies), int(bodies["island"][0]))
    assert bodies["asleep"].tolist() == [0, 0]
    assert bodies[list(INVERSE)].tolist() == before.tolist()
