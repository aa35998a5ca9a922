"""Measures of rest, of energy and of solver residuals on logs with known answers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.lib.recfunctions import append_fields
from synthetic import GRAVITY, MASS, RESIDUAL, trace_of

from lavendersim.measures import evaluate
from lavendersim.measures.specs.convergence import FinalResidual, ResidualBySweep
from lavendersim.measures.specs.energy import EnergyAfterBounces, EnergyByBounce
from lavendersim.measures.specs.steady import (
    MaxPenetration,
    SettlingTime,
    SimulatedDuration,
    SteadyForce,
    SteadyPenetration,
    SteadyTorque,
)


def resting(rows: int = 41) -> object:
    """A ball that rests 3 mm deep; the force ripples by 1 N around 20 N in the last 0.1 s."""
    forces = [20.0 + (1.0 if step == rows - 2 else -1.0 / 9.0) for step in range(1, rows)]
    touching = [(step, force / 100.0, 0.003) for step, force in enumerate(forces, start=1)]
    return trace_of([-0.003] * rows, touching)


def test_steady_force_is_the_mean_of_the_last_window() -> None:
    spec = SteadyForce(kind="steady_force", body="ball", last=0.1)
    # ten forces of 20 N: nine at 20 - 1/9, one at 21; the window holds the last ten steps
    assert evaluate(spec, resting()) == pytest.approx(20.0, rel=1e-14)


def test_furthest_force_is_the_value_furthest_from_the_mean() -> None:
    spec = SteadyForce(kind="steady_force", body="ball", last=0.1, statistic="furthest")
    assert evaluate(spec, resting()) == pytest.approx(21.0, rel=1e-14)


def test_a_window_longer_than_the_run_is_no_answer() -> None:
    spec = SteadyForce(kind="steady_force", body="ball", last=5.0)
    assert math.isnan(evaluate(spec, resting()))


def aside(**more: float) -> object:
    """A ball whose centre is at (0, 0, 1) m, pushed up by 2 N at (0.3, 0, 0) m; columns beside."""
    log = trace_of([1.0 - 0.1] * 11, [(step, 0.02, 0.0) for step in range(1, 11)])
    columns = {"x": 0.3, "y": 0.0, "z": 0.0} | more
    full = [np.full(len(log.contact), value) for value in columns.values()]
    log.contact = append_fields(log.contact, list(columns), full, usemask=False)
    return log


def torque(log: object, body: str, along: tuple[float, float, float]) -> float:
    kind = {"kind": "steady_torque", "body": body, "along": along, "last": 0.05}
    return evaluate(SteadyTorque.model_validate(kind), log)


def test_steady_torque_is_that_on_the_body_about_its_centre() -> None:
    # (0.3, 0, -1) x (0, 0, 2) = (0, -0.6, 0); on the floor, whose place is the origin, as much back
    assert torque(aside(), "ball", (0.0, 3.0, 0.0)) == pytest.approx(-0.6, rel=1e-14)
    assert torque(aside(), "floor", (0.0, 3.0, 0.0)) == pytest.approx(0.6, rel=1e-14)
    assert torque(aside(), "ball", (0.0, 0.0, 1.0)) == 0.0


def test_steady_torque_has_the_couples_of_surfaces() -> None:
    spun = aside(angular_impulse_n=0.003, patch_impulse_n=0.001)  # about z, each 10 ms
    assert torque(spun, "ball", (0.0, 0.0, 1.0)) == pytest.approx(0.4, rel=1e-14)
    frame = {"t1x": 0.0, "t1y": 1.0, "t1z": 0.0, "impulse_t1": 0.0, "impulse_t2": 0.0}
    rolled = aside(**frame, angular_impulse_t1=0.002, angular_impulse_t2=0.005)
    # t2 = n x t1 = -x
    assert torque(rolled, "ball", (0.0, 1.0, 0.0)) == pytest.approx(0.2 - 0.6, rel=1e-14)
    assert torque(rolled, "ball", (1.0, 0.0, 0.0)) == pytest.approx(-0.5, rel=1e-14)


def test_steady_penetration_with_and_without_the_slop() -> None:
    spec = SteadyPenetration(kind="steady_penetration", body="ball", last=0.1)
    assert evaluate(spec, resting()) == pytest.approx(0.003, rel=1e-14)
    beyond = spec.model_copy(update={"above_slop": True})
    assert evaluate(beyond, resting()) == pytest.approx(0.002, rel=1e-14)


def test_penetration_of_several_contacts_is_the_deepest() -> None:
    spec = MaxPenetration(kind="max_penetration", body="ball")
    assert evaluate(spec, trace_of([0.0] * 3, [(1, 0.1, 0.002), (1, 0.1, 0.004)])) == 0.004


def test_settling_time_counts_from_first_contact_to_the_last_step_above() -> None:
    spec = SettlingTime(kind="settling_time", body="ball", threshold=0.001)
    touching = [(2, 1.0, 0.004), (3, 1.0, 0.0005), (4, 1.0, 0.002), (5, 1.0, 0.0005)]
    # last step above is 4, below from step 5 on, first contact in step 2: 3 steps of 10 ms
    assert evaluate(spec, trace_of([0.0] * 8, touching)) == pytest.approx(0.03, rel=1e-12)


def test_a_body_still_deep_at_the_end_has_not_settled() -> None:
    spec = SettlingTime(kind="settling_time", body="ball", threshold=0.001)
    assert math.isnan(evaluate(spec, trace_of([0.0] * 3, [(1, 1.0, 0.004), (2, 1.0, 0.004)])))


def test_simulated_duration_is_the_time_of_the_last_row() -> None:
    spec = SimulatedDuration(kind="simulated_duration")
    assert evaluate(spec, trace_of([0.0] * 41)) == pytest.approx(0.4, rel=1e-15)


def bouncing(apexes: list[float]) -> object:
    """Heights that touch the floor between apexes, at rest in each apex."""
    heights, touching = [1.0], []
    for apex in apexes:
        touching.append((len(heights), 1.0, 0.0))
        heights += [0.0, 0.5 * apex, apex, 0.5 * apex]
    heights.append(0.0)
    return trace_of(heights, touching, [0.0] * len(heights))


def test_energy_by_bounce_is_the_share_of_height_won_or_lost() -> None:
    spec = EnergyByBounce(kind="energy_by_bounce", body="ball", above="floor", bounces=3)
    # energy m g (h + r) less m g r at rest: round-off of 2e-15 J / 20 J, a few times over
    expected = [-0.1, -0.2, 0.05]
    np.testing.assert_allclose(evaluate(spec, bouncing([0.9, 0.8, 1.05])), expected, atol=1e-14)
    last = EnergyAfterBounces(kind="energy_after_bounces", body="ball", above="floor", bounces=3)
    assert evaluate(last, bouncing([0.9, 0.8, 1.05])) == pytest.approx(0.05, abs=1e-14)


def test_bounces_the_run_does_not_reach_are_nan() -> None:
    spec = EnergyByBounce(kind="energy_by_bounce", body="ball", above="floor", bounces=3)
    assert np.isnan(evaluate(spec, bouncing([0.9, 0.8]))).tolist() == [False, False, True]


def test_a_ball_still_rising_at_the_end_has_not_reached_its_apex() -> None:
    spec = EnergyByBounce(kind="energy_by_bounce", body="ball", above="floor", bounces=1)
    log = trace_of([1.0, 0.0, 0.3, 0.6], [(1, 1.0, 0.0)], [0.0] * 4)
    assert np.isnan(evaluate(spec, log)).tolist() == [True]


def test_kinetic_energy_counts() -> None:
    log = bouncing([0.9])
    log.step["kinetic_energy"][3] = MASS * GRAVITY * 0.1  # at the apex
    spec = EnergyAfterBounces(kind="energy_after_bounces", body="ball", above="floor", bounces=1)
    assert evaluate(spec, log) == pytest.approx(0.0, abs=1e-14)


def with_residuals() -> object:
    log = trace_of([0.0] * 5)
    log.residual = np.array(
        [(2, 0, 9.0), (3, 2, 0.25), (3, 0, 1.0), (3, 1, 0.5), (4, 0, 7.0)], RESIDUAL
    )
    log.step["residual"] = [0.0, 8.0, 4.0, 0.25, 1.0]
    return log


def test_residual_by_sweep_of_the_first_step_after_a_time() -> None:
    spec = ResidualBySweep(kind="residual_by_sweep", after=0.02)  # step 3 ends at 0.03
    assert evaluate(spec, with_residuals()).tolist() == [1.0, 0.5, 0.25]


def test_final_residual_of_the_same_step() -> None:
    assert evaluate(FinalResidual(kind="final_residual", after=0.02), with_residuals()) == 0.25


@pytest.mark.parametrize("after", [0.0, 9.0])  # a step without residuals; no step at all
def test_residuals_that_were_not_logged_are_nan(after: float) -> None:
    spec = ResidualBySweep(kind="residual_by_sweep", after=after)
    assert np.isnan(evaluate(spec, with_residuals())).all()
