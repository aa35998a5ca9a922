"""On a log without /contacts a measure or a curve of contacts says so, and no other minds."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic import SyntheticCell, SyntheticTrace, trace_of

from lavendersim.errors import UsageError
from lavendersim.figures.panels.time_series import window_of
from lavendersim.figures.specs.time_series import TimeSeries
from lavendersim.measures.judging import judge
from lavendersim.measures.registry import evaluate
from lavendersim.measures.specs.convergence import FinalResidual, ResidualBySweep
from lavendersim.measures.specs.energy import EnergyAfterBounces, EnergyByBounce
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.measures.specs.impact import (
    ApproachVelocity,
    FirstApex,
    ImpactImpulse,
    ImpulseBalance,
    InverseEffectiveMass,
    MomentumDrift,
    PeakForce,
    SeparationVelocity,
    StepImpulse,
    StepsAboveForce,
)
from lavendersim.measures.specs.laws import EnergyDrift, ForceError
from lavendersim.measures.specs.motion import Drift
from lavendersim.measures.specs.optimality import Optimality
from lavendersim.measures.specs.overlap import Overlap
from lavendersim.measures.specs.steady import (
    MaxPenetration,
    SettlingTime,
    SimulatedDuration,
    SteadyForce,
    SteadyPenetration,
)
from lavendersim.trace.absent import absent_table

SAYS = "free.mcap: this log has no /contacts: nothing can touch (plan: contact_log off)"
SWEEPS = "free.mcap: this log has no /residuals: record.residuals is none (plan: residual_log off)"
BALL = {"body": "ball", "other": "floor"}
OVER = {"body": "ball", "above": "floor"}

OF_CONTACTS = [
    FirstApex(kind="first_apex", **OVER),
    ImpactImpulse(kind="impact_impulse", **BALL),
    StepImpulse(kind="step_impulse", step=2, **BALL),
    ApproachVelocity(kind="approach_velocity", **BALL),
    SeparationVelocity(kind="separation_velocity", **BALL),
    InverseEffectiveMass(kind="inverse_effective_mass", **BALL),
    PeakForce(kind="peak_force", **BALL),
    StepsAboveForce(kind="steps_above_force", threshold=1.0, **BALL),
    ImpulseBalance(kind="impulse_balance"),
    SteadyForce(kind="steady_force", last=0.02, **BALL),
    SteadyPenetration(kind="steady_penetration", last=0.02, **BALL),
    MaxPenetration(kind="max_penetration", **BALL),
    SettlingTime(kind="settling_time", threshold=1e-3, **BALL),
    EnergyByBounce(kind="energy_by_bounce", bounces=1, **OVER),
    EnergyAfterBounces(kind="energy_after_bounces", bounces=1, **OVER),
    ForceError(kind="force_error", last=0.02),
    Optimality(kind="optimality"),
]
OF_THE_REST = [
    MomentumDrift(kind="momentum_drift"),
    SimulatedDuration(kind="simulated_duration"),
    FinalResidual(kind="final_residual", after=0.01),
    EnergyDrift(kind="energy_drift"),
    Drift(kind="drift", after=0.0),
    Overlap(kind="overlap", last=0.02),
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
        evaluate(ResidualBySweep(kind="residual_by_sweep", after=0.0), free)
    assert str(caught.value) == SWEEPS


@pytest.mark.parametrize("spec", OF_THE_REST, ids=lambda spec: spec.kind)
def test_a_measure_of_steps_and_poses_does_not_mind(spec, free) -> None:
    assert np.isfinite(evaluate(spec, free))


def test_the_verdict_of_a_claim_is_that_sentence(free) -> None:
    measures = {"peak": PeakForce(kind="peak_force", **BALL)}
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
