"""Residuals of one step, sweep by sweep or after the last sweep."""

from __future__ import annotations

import numpy as np

from lavendersim.measures.columns import first_ending_after
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import convergence as specs


@measure(specs.ResidualBySweep)
def residual_by_sweep(spec: specs.ResidualBySweep, trace: Trace) -> Floats:
    """Return the residuals [m/s] before sweep 1 and after each sweep; one NaN if not logged."""
    row = first_ending_after(trace, spec.after)
    if row is None:
        return np.array([np.nan])
    chosen = trace.residual[trace.residual["step"] == trace.step["step"][row]]
    if len(chosen) == 0:
        return np.array([np.nan])
    residuals: Floats = chosen["residual"][np.argsort(chosen["sweep"], kind="stable")]
    return residuals


@measure(specs.FinalResidual)
def final_residual(spec: specs.FinalResidual, trace: Trace) -> float:
    """Return the residual [m/s] that the step was left with; NaN if no step ends after the time."""
    row = first_ending_after(trace, spec.after)
    return float("nan") if row is None else float(trace.step["residual"][row])
