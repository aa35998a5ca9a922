"""Energy of a bouncing body: what it keeps or gains from bounce to bounce."""

from __future__ import annotations

import numpy as np

from lavendersim.measures.columns import (
    clearance_by_step,
    contacts_of,
    energy_at_rest,
    mechanical_energy,
    pushing_runs,
)
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import energy as specs


@measure(specs.EnergyByBounce)
def energy_by_bounce(spec: specs.EnergyByBounce, trace: Trace) -> Floats:
    """Return E_k / E_0 - 1 after bounce k = 1, 2, ...; see `_by_bounce`."""
    return _by_bounce(spec, trace)


@measure(specs.EnergyAfterBounces)
def energy_after_bounces(spec: specs.EnergyAfterBounces, trace: Trace) -> float:
    """Return the last number of `energy_by_bounce`."""
    return float(_by_bounce(spec, trace)[-1])


def _by_bounce(spec: specs.EnergyByBounce | specs.EnergyAfterBounces, trace: Trace) -> Floats:
    """Return E_k / E_0 - 1 after bounce k = 1, 2, ...; NaN for apexes the run does not reach.

    Energy is counted from rest on the surface. E_k is read in the state nearest the apex, where
    the scheme's own ripple m g v dt / 2 is least: at most m (g dt)^2 / 4.
    """
    drift = np.full(spec.bounces, np.nan)
    heights = clearance_by_step(trace, spec.body, spec.above)
    at_rest = energy_at_rest(trace, spec.body, spec.above, float(heights[0]))
    energy = mechanical_energy(trace) - at_rest
    runs = pushing_runs(trace, contacts_of(trace, spec.body, spec.above))
    ends = [first for first, _ in runs[1:]] + [len(heights)]
    for bounce, ((_, last), end) in enumerate(zip(runs, ends, strict=False)):  # or no run at all
        if bounce == spec.bounces:
            break
        apex = last + int(np.argmax(heights[last:end]))
        if last < apex < len(heights) - 1:  # an apex at the last row is not one yet
            drift[bounce] = float(energy[apex]) / float(energy[0]) - 1.0
    return drift
