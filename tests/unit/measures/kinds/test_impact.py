"""Measures of an impact on logs whose answers are known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from synthetic import GRAVITY, MASS, ball_and_floor, trace_of

from lavendersim.measures import evaluate
from lavendersim.measures.kinds.impact import parabola_vertex
from lavendersim.measures.specs import impact as specs
from lavendersim.measures.specs.base import ClosedForm

APEX = specs.FirstApex(kind="first_apex", body="ball", above="floor")
IMPULSE = specs.ImpactImpulse(kind="impact_impulse", body="ball", other="floor")


def bounce(apex: float, shift: float) -> list[float]:
    """Fall to -2 mm, then a parabola with this apex, sampled `shift` of a step beside it."""
    k = np.arange(-5, 8) + shift
    return [0.3, 0.1, -0.002, *(apex - 0.5 * GRAVITY * (k / 100.0) ** 2)]


@pytest.mark.parametrize("shift", [-0.49, -0.2, 0.0, 0.3, 0.49])
def test_apex_is_the_vertex_wherever_the_samples_fall(shift: float) -> None:
    measured = evaluate(APEX, trace_of(bounce(0.05, shift), [(3, 1.0, 0.002)]))
    # three samples of about 0.05 m with round-off 7e-18 each, second difference 1e-3: 1e-15
    assert measured == pytest.approx(0.05, abs=1e-14)


def test_apex_is_not_the_largest_sample() -> None:
    heights = bounce(0.05, 0.49)
    measured = evaluate(APEX, trace_of(heights, [(3, 1.0, 0.002)]))
    assert measured > max(heights[3:]) + 1e-4


def test_only_the_first_apex_counts() -> None:
    heights = [*bounce(0.02, 0.0), 0.001, 0.4, 0.1]
    measured = evaluate(APEX, trace_of(heights, [(3, 1.0, 0.002)]))
    assert measured == pytest.approx(0.02, abs=1e-14)


def test_a_body_that_stays_down_rebounds_zero() -> None:
    heights = [0.1, -0.02, -0.01, -0.005, -0.002, -0.001]
    assert evaluate(APEX, trace_of(heights, [(2, 1.0, 0.02), (3, 0.1, 0.01)])) == 0.0


def test_no_apex_before_the_run_ends_is_nan() -> None:
    heights = [0.1, -0.02, 0.01, 0.05, 0.1]
    assert math.isnan(evaluate(APEX, trace_of(heights, [(2, 1.0, 0.02)])))


def test_a_body_that_never_touches_has_no_rebound() -> None:
    assert math.isnan(evaluate(APEX, trace_of([0.1, 0.2, 0.1, 0.05])))


def test_three_equal_samples_have_their_own_height_as_vertex() -> None:
    assert parabola_vertex(2.0, 2.0, 2.0) == 2.0


def test_impulse_sums_the_first_run_of_pushing_steps_only() -> None:
    touching = [(2, 1.5, 0.01), (3, 0.25, 0.005), (4, 0.0, 0.001), (6, 8.0, 0.01)]
    assert evaluate(IMPULSE, trace_of([0.0] * 8, touching)) == 1.75


def test_a_contact_that_never_pushes_gives_exactly_zero() -> None:
    assert evaluate(IMPULSE, trace_of([0.0] * 4, [(1, 0.0, 1e-4)])) == 0.0


def test_without_any_contact_the_impulse_is_unknown_not_zero() -> None:
    assert math.isnan(evaluate(IMPULSE, trace_of([0.1] * 4)))


def test_impulse_of_one_step() -> None:
    spec = specs.StepImpulse(kind="step_impulse", body="ball", step=3)
    touching = [(2, 1.5, 0.01), (3, 0.25, 0.005)]
    assert evaluate(spec, trace_of([0.0] * 5, touching)) == 0.25
    assert math.isnan(evaluate(spec.model_copy(update={"step": 99}), trace_of([0.0] * 5, touching)))


@pytest.mark.parametrize(
    ("kind", "model", "expected"),
    [
        ("approach_velocity", specs.ApproachVelocity, -2.0),
        ("separation_velocity", specs.SeparationVelocity, 1.0),
        ("inverse_effective_mass", specs.InverseEffectiveMass, 0.5),
        ("peak_force", specs.PeakForce, 150.0),
    ],
)
def test_first_contact_and_peak(kind: str, model: type, expected: float) -> None:
    spec = model(kind=kind, body="ball")
    touching = [(2, 1.5, 0.01), (5, 0.25, 0.005)]
    assert evaluate(spec, trace_of([0.0] * 7, touching)) == expected
    assert math.isnan(evaluate(spec, trace_of([0.1] * 7)))


def test_forces_of_one_step_are_summed_before_they_are_compared() -> None:
    spec = specs.StepsAboveForce(kind="steps_above_force", body="ball", threshold=100.0)
    touching = [(2, 0.6, 0.01), (2, 0.6, 0.01), (3, 0.6, 0.01)]  # 120 N together, then 60 N
    assert evaluate(spec, trace_of([0.0] * 5, touching)) == 1.0


def falling_log(impulse: float) -> object:
    """Five states around an impact in step 3 that changes -2 m/s to +1 m/s, gravity included."""
    weight = MASS * GRAVITY / 100.0
    before = -2.0
    after = before + (impulse - weight) / MASS
    return trace_of([0.1, 0.05, -0.01, 0.0, 0.01], [(3, impulse, 0.01)], [0, 0, before, after, 0])


def test_impulse_balances_momentum_and_weight() -> None:
    spec = specs.ImpulseBalance(kind="impulse_balance")
    # sums of a few numbers of size 6 N s: round-off 1e-15
    assert evaluate(spec, falling_log(6.0)) < 1e-14


def test_a_missing_tenth_of_the_impulse_shows_in_the_balance() -> None:
    spec = specs.ImpulseBalance(kind="impulse_balance")
    log = falling_log(6.0)
    log.contact["impulse_n"] *= 0.9
    assert evaluate(spec, log) == pytest.approx(1.0 / 9.0, rel=1e-12)


def test_balance_counts_the_impulse_on_the_movable_side() -> None:
    spec = specs.ImpulseBalance(kind="impulse_balance")
    log = falling_log(6.0)
    log.contact["body_a"], log.contact["body_b"] = 1, 0
    log.contact["nz"] = -1.0
    assert evaluate(spec, log) < 1e-14


def test_balance_is_unknown_when_a_mass_changes_on_the_way() -> None:
    log = falling_log(6.0)
    log.resolved = ball_and_floor() | {"events": [{"at": 0.0, "body": "ball", "scale_mass": 1.05}]}
    assert math.isnan(evaluate(specs.ImpulseBalance(kind="impulse_balance"), log))


def test_momentum_drift_is_relative_to_the_largest_momentum() -> None:
    log = trace_of([0.0] * 3, speeds=[-2.0, -2.0, -1.5])
    assert evaluate(specs.MomentumDrift(kind="momentum_drift"), log) == 0.25


def test_over_and_against_a_closed_form() -> None:
    form = ClosedForm(form="rebound_height", bodies=("ball", "floor"))  # 0.25 * 1 m
    log = trace_of(bounce(0.3, 0.0), [(3, 1.0, 0.002)])
    over = evaluate(APEX.model_copy(update={"over": form}), log)
    against = evaluate(APEX.model_copy(update={"against": form}), log)
    assert over == pytest.approx(1.2, rel=1e-13)
    assert against == pytest.approx(0.2, rel=1e-12)
