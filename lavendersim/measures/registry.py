"""A measure's spec and a log in; its number, or row of numbers, out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from lavendersim.experiment.measure_specs import MeasureSpec
from lavendersim.measures import (
    convergence,
    energy,
    impact,
    kinematics,
    laws,
    motion,
    optimality,
    overlap,
    spinning,
    steady,
)
from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.selection import selects
from lavendersim.measures.views import Trace, Value

MEASURES: Final[dict[str, Callable[[Any, Trace], Value]]] = {
    "first_apex": impact.first_apex,
    "impact_impulse": impact.impact_impulse,
    "step_impulse": impact.step_impulse,
    "approach_velocity": impact.approach_velocity,
    "separation_velocity": impact.separation_velocity,
    "inverse_effective_mass": impact.inverse_effective_mass,
    "peak_force": impact.peak_force,
    "steps_above_force": impact.steps_above_force,
    "impulse_balance": impact.impulse_balance,
    "momentum_drift": impact.momentum_drift,
    "steady_force": steady.steady_force,
    "steady_penetration": steady.steady_penetration,
    "max_penetration": steady.max_penetration,
    "settling_time": steady.settling_time,
    "simulated_duration": steady.simulated_duration,
    "residual_by_sweep": convergence.residual_by_sweep,
    "final_residual": convergence.final_residual,
    "energy_by_bounce": energy.energy_by_bounce,
    "energy_after_bounces": energy.energy_after_bounces,
    "apex_error": motion.apex_error,
    "drift": motion.drift,
    "overlap": overlap.overlap,
    "slip_distance": motion.slip_distance,
    "creep": motion.creep,
    "effective_friction": motion.effective_friction,
    "passed_through": motion.passed_through,
    "displacement": kinematics.displacement,
    "mean_velocity": kinematics.mean_velocity,
    "mean_angular_velocity": kinematics.mean_angular_velocity,
    "top_speed": kinematics.top_speed,
    "rest_time": kinematics.rest_time,
    "tilt": kinematics.tilt,
    "force_error": laws.force_error,
    "energy_drift": laws.energy_drift,
    "energy_gain": laws.energy_gain,
    "angular_momentum_drift": laws.angular_momentum_drift,
    "velocity_error": spinning.velocity_error,
    "angular_velocity_error": spinning.angular_velocity_error,
    "flip_time_error": spinning.flip_time_error,
    "optimality": optimality.optimality,
    "law_violation": laws.law_violation,
    "unsolved_steps": laws.unsolved_steps,
}


def evaluate(spec: MeasureSpec, trace: Trace) -> Value:
    """Return the measure of one log: a float, or a 1-D array for kinds that give a row.

    NaN where the log cannot answer, or a closed form to divide by is 0.
    """
    value = MEASURES[spec.kind](spec, trace)
    form = spec.over or spec.against
    if form is None:
        return value
    ideal = evaluate_form(form, trace.resolved)
    if ideal == 0.0:
        return float("nan")
    fraction: Value = value / ideal
    return fraction if spec.over else np.abs(fraction - 1.0)


def applies(spec: MeasureSpec, coordinates: Mapping[str, Any]) -> bool:
    """Tell whether the measure is taken in the cell with these coordinates (its `at`)."""
    return selects(spec.at, coordinates)
