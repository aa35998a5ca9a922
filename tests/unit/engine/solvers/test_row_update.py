"""One row, one step, by hand: lambda = -(v_n + b + b_rest) / (k_n + gamma) with each term in turn.

A 1 kg sphere (k = 1/kg) over the floor, warm start off, dt = 1/240 s, no gravity unless given.
"""

from __future__ import annotations

import pytest
from laboratory import Bench, plane, resolved, sphere

DT = 1.0 / 240.0


def impulse(speed, depth=0.0, restitution=0.0, compliance=0.0, gravity=0.0, **numerics):
    bodies = {
        "floor": plane(compliance=0.25 * compliance),
        "ball": sphere(
            0.1,
            (0.0, 0.0, 0.1 - depth),
            velocity=(0.0, 0.0, -speed),
            restitution=restitution,
            compliance=0.75 * compliance,
        ),
    }
    cell = resolved(bodies, (0.0, 0.0, -gravity), warm_start=False, **numerics)
    return Bench(cell).run(1).contact[0]["impulse_n"]


def test_compliance_is_divided_by_the_square_of_the_timestep():
    for compliance in (1e-7, 1e-5, 1e-3):
        assert impulse(2.0, compliance=compliance) == pytest.approx(
            2.0 / (1.0 + compliance * 240.0**2), rel=1e-12
        )


def test_bias_is_gain_over_timestep_times_the_depth_beyond_slop():
    found = impulse(0.0, depth=0.003, stabilisation_gain=0.02, slop=0.001)
    # The depth 0.1 - (0.1 - 0.003) has lost some digits: 1e-17 of 2e-3.
    assert found == pytest.approx(0.02 * 240.0 * 0.002, rel=1e-13)


def test_penetration_within_slop_gets_no_bias():
    assert impulse(0.0, depth=0.0009, stabilisation_gain=0.02, slop=0.001) == 0.0


def test_restitution_and_bias_are_summed():
    found = impulse(2.0, depth=0.003, restitution=0.5, stabilisation_gain=0.02, slop=0.001)
    assert found == pytest.approx(2.0 * 1.5 + 0.02 * 240.0 * 0.002, rel=1e-13)


@pytest.mark.parametrize(("share", "bounces"), [(0.999, False), (1.001, True)])
def test_restitution_applies_above_the_threshold_and_not_below(share, bounces):
    """With this step's g dt, the ball arrives at the share of 2 g dt less one g dt."""
    threshold = 2.0 * 9.81 * DT
    speed = share * threshold - 9.81 * DT
    found = impulse(speed, restitution=0.5, gravity=9.81)
    assert found == pytest.approx(share * threshold * (1.5 if bounces else 1.0), rel=1e-13)


def test_the_bounce_survives_every_number_of_sweeps():
    """Captured once: a target taken anew in each sweep would be erased by the second."""
    for sweeps in (1, 2, 22):
        assert impulse(2.0, restitution=0.8, sweeps=sweeps) == pytest.approx(3.6, rel=1e-15)


def test_force_of_a_step_is_impulse_over_timestep():
    bodies = {"floor": plane(), "ball": sphere(0.1, (0, 0, 0.1), velocity=(0, 0, -2.0))}
    rows = Bench(resolved(bodies)).run(1)
    assert rows.contact[0]["force_n"] == pytest.approx(480.0, rel=1e-15)
    assert rows.step[-1]["total_normal_force"] == rows.contact[0]["force_n"]
