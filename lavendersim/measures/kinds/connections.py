"""Tension of a rope."""

from __future__ import annotations

from lavendersim.engine.effects import pulling
from lavendersim.measures.columns import last_window, summed_by_step
from lavendersim.measures.interfaces import Trace
from lavendersim.measures.registration import measure
from lavendersim.measures.specs import connections as specs


@measure(specs.Tension)
def tension(spec: specs.Tension, trace: Trace) -> float:
    """Return the mean tension [N] of the last window, or its largest.

    NaN for a run shorter than the window, and of a rope between bodies that do not move.
    """
    ropes = list(pulling(trace.config.scene))
    window = last_window(trace, spec.last)
    if spec.connection not in ropes or not window.any():
        return float("nan")
    rows = trace.contact
    own = rows[rows["rope"] == 1 + ropes.index(spec.connection)]
    forces = summed_by_step(trace, own, "force_n")[window]
    return float(forces.mean() if spec.statistic == "mean" else forces.max())
