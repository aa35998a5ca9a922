"""Steady force, penetration and settling time of a body that comes to rest."""

from __future__ import annotations

import numpy as np

from lavendersim.measures.columns import (
    contacts_of,
    deepest_by_step,
    last_window,
    summed_by_step,
)
from lavendersim.measures.interfaces import Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import steady as specs

NAN = float("nan")


@measure(specs.SteadyForce)
def steady_force(spec: specs.SteadyForce, trace: Trace) -> float:
    """Return the mean normal force [N] of the last window, or its value furthest from the mean."""
    rows = contacts_of(trace, spec.body, spec.other)
    forces = summed_by_step(trace, rows, "force_n")[last_window(trace, spec.last)]
    if len(forces) == 0 or len(rows) == 0:
        return NAN
    mean = float(forces.mean())
    if spec.statistic == "mean":
        return mean
    return float(forces[np.argmax(np.abs(forces - mean))])


@measure(specs.SteadyPenetration)
def steady_penetration(spec: specs.SteadyPenetration, trace: Trace) -> float:
    """Return the mean of the deepest penetration [m] in the last window; NaN without contact."""
    rows = contacts_of(trace, spec.body, spec.other)
    depths = deepest_by_step(trace, rows)[last_window(trace, spec.last)]
    if len(depths) == 0 or len(rows) == 0:
        return NAN
    above = trace.config.numerics.slop if spec.above_slop else 0.0
    return float(depths.mean()) - above


@measure(specs.MaxPenetration)
def max_penetration(spec: specs.MaxPenetration, trace: Trace) -> float:
    """Return the deepest penetration [m] of the whole run; NaN if nothing touches the body."""
    rows = contacts_of(trace, spec.body, spec.other)
    return float(rows["penetration"].max()) if len(rows) else NAN


@measure(specs.SettlingTime)
def settling_time(spec: specs.SettlingTime, trace: Trace) -> float:
    """Return the time [s] from first contact until the penetration stays below the threshold.

    NaN if nothing touches the body, or the penetration is still above at the end.
    """
    rows = contacts_of(trace, spec.body, spec.other)
    if len(rows) == 0:
        return NAN
    time = trace.step["time"]
    above = np.flatnonzero(deepest_by_step(trace, rows) > spec.threshold)
    if len(above) == 0:
        return 0.0
    if above[-1] + 1 == len(time):
        return NAN
    touch = np.searchsorted(trace.step["step"], rows["step"][0])
    return float(time[above[-1] + 1] - time[touch])


@measure(specs.SimulatedDuration)
def simulated_duration(spec: specs.SimulatedDuration, trace: Trace) -> float:
    """Return the simulated time [s] of the last logged step."""
    return float(trace.step["time"][-1])
