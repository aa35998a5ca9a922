"""Counts of searches on shapes that took all their iterations (`iteration_limits`)."""

from __future__ import annotations

from ..compile import inner, kernel, once
from ..effects import has_hook
from ..spec import Spec
from .iteration_limits import has_advance, has_ascent, has_epa, has_gjk


@inner
def forget_limits(scratch):
    """Forget what was counted in a part of the step that is begun anew."""
    counted = scratch.not_converged[0]
    counted.gjk, counted.epa, counted.ascent, counted.advance, counted.impact = 0, 0, 0, 0, 0


@once
def make_count_limits(spec: Spec):
    """Return `kernel(scratch, counters)`: `counters` tells of the step so far."""
    gjk, epa, ascends = has_gjk(spec), has_epa(spec), has_ascent(spec)
    advances, orders = has_advance(spec), has_hook(spec, "order_impacts")

    def count_limits(scratch, counters):
        counted = scratch.not_converged[0]
        if gjk:
            counters.gjk_not_converged += counted.gjk
        if epa:
            counters.epa_not_converged += counted.epa
        if ascends:
            counters.ascent_not_converged += counted.ascent
        if advances:
            counters.advance_not_converged += counted.advance
        if orders:
            counters.impact_not_converged += counted.impact
        forget_limits(scratch)

    return kernel(count_limits, spec)
