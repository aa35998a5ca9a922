"""On a log without /contacts a measure or a curve of contacts says so, and no other minds."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic import SyntheticCell, SyntheticTrace, trace_of

from lavendersim.errors import UsageError
from lavendersim.experiment.models import law_measures as law_specs
from lavendersim.experiment.models import measures as measure_specs
from lavendersim.experiment.models import motion_measures as motion_specs
from lavendersim.experiment.models.expect import ExpectSpec
from lavendersim.experiment.models.figure import TimeSeries
from lavendersim.figures.time_series import window_of
from lavendersim.measures.judge import judge
from lavendersim.measures.registry import evaluate
from lavendersim.trace.absent import absent_table

SAYS = "free.mcap: this log has no /contacts: nothing can touch (plan: contact_log off)"
SWEEPS = "free.mcap: this log has no /residuals: record.residuals is none (plan: residual_log off)"
BALL = {"body": "ball", "other": "floor"}
OVER = {"body": "ball", "above": "floor"}

OF_CONTACTS = [
    measure_specs.FirstApex(kind="first_apex", **OVER),
    measure_specs.ImpactImpulse(kind="impact_impulse", **BALL),
    measure_specs.StepImpulse(kind="step_impulse", step=2, **BALL),
    measure_specs.ApproachVelocity(kind="approach_velocity", **BALL),
    measure_specs.SeparationVelocity(kind="separation_velocity", **BALL),
    measure_specs.InverseEffectiveMass(kind="inverse_effective_mass", **BALL),
    measure_specs.PeakForce(kind="peak_force", **BALL),
    measure_specs.StepsAboveForce(kind="steps_above_force", threshold=1.0, **BALL),
    measure_specs.ImpulseBalance(kind="impulse_balance"),
    measure_specs.SteadyForce(kind="steady_force", last=0.02, **BALL),
    measure_specs.SteadyPenetration(kind="steady_penetration", last=0.02, **BALL),
    measure_specs.MaxPenetration(kind="max_penetration", **BALL),
    measure_specs.SettlingTime(kind="settling_time", threshold=1e-3, **BALL),
    measure_specs.EnergyByBounce(kind="energy_by_bounce", bounces=1, **OVER),
    measure_specs.EnergyAfterBounces(kind="energy_after_bounces", bounces=1, **OVER),
    law_specs.ForceError(kind="force_error", last=0.02),
    law_specs.Optimality(kind="optimality"),
]
OF_THE_REST = [
    measure_specs.MomentumDrift(kind="momentum_drift"),
    measure_specs.SimulatedDuration(kind="simulated_duration"),
    measure_specs.FinalResidual(kind="final_residual", after=0.01),
    law_specs.EnergyDrift(kind="energy_drift"),
    motion_specs.Drift(kind="drift", after=0.0),
    motion_specs.Overlap(kind="overlap", last=0.02),
]


@pytest.fixture
def free() -> SyntheticTrace:
    log = trace_of([1.0, 1.1, 1.2, 1.3], speeds=[10.0] * 4)
    log.contact, log.residual = absent_table(SAYS), absent_table(SWEEPS)
    return log


@pytest.mark.parametrize("spec", OF_CONTACTS, ids=lambda spec: spec.kind)
def test_a_measure_of_contacts_says_that_there_are_none_to_measure(spec, free) -> None:
    with pytest.raises(UsageError) as caught:
        evaluate(spec, free)
    assert str(caught.value) == SAYS


def test_a_measure_of_sweeps_says_that_none_were_asked_for(free) -> None:
    with pytest.raises(UsageError) as caught:
        evaluate(measure_specs.ResidualBySweep(kind="residual_by_sweep", after=0.0), free)
    assert str(caught.value) == SWEEPS


@pytest.mark.parametrize("spec", OF_THE_REST, ids=lambda spec: spec.kind)
def test_a_measure_of_steps_and_poses_does_not_mind(spec, free) -> None:
    assert np.isfinite(evaluate(spec, free))


def test_the_verdict_of_a_claim_is_that_sentence(free) -> None:
    measures = {"peak": measure_specs.PeakForce(kind="peak_force", **BALL)}
    claim = ExpectSpec(name="it is gentle", measure="peak", at_most=10.0)
    (verdict,) = judge(measures, [claim], [SyntheticCell({}, free)])
    assert not verdict.passed
    assert f"because    {SAYS}\n" in verdict.message


def panel(**keys: object) -> TimeSeries:
    labels = {"title": "t", "x_label": "time [s]", "y_label": "y"}
    return TimeSeries(kind="time_series", **labels, **keys)


@pytest.mark.parametrize(
    "keys",
    [
        {"column": "normal_force"},
        {"column": "penetration"},
        {"column": "normal_force", "body": "ball"},
        {"column": "energy", "start": "first_contact"},
    ],
)
def test_a_curve_of_contacts_says_that_there_are_none_to_draw(keys, free) -> None:
    with pytest.raises(UsageError) as caught:
        window_of(panel(**keys), free)
    assert str(caught.value) == SAYS


def test_a_curve_of_steps_is_drawn(free) -> None:
    time, energy = window_of(panel(column="energy"), free)
    assert len(time) == len(energy) == len(free.step)
