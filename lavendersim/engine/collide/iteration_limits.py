"""Calls of GJK and EPA that took all their iterations: which engines have them, and their counts.

Such a call gives what it found so far, as if it had ended by its tolerance; the step says how many
there were (`gjk_not_converged`, `epa_not_converged` of /step).
"""

from __future__ import annotations

from ..compile import inner, kernel, once
from ..spec import Spec
from .pairs import SHAPE_PAIRS, box_box, convex
from .swept import needs_separation


def has_epa(spec: Spec) -> bool:
    """Whether depths of convex bodies are looked for by EPA, from where GJK ends."""
    return any(SHAPE_PAIRS[name].make is convex.make for name in spec.shape_pairs)


def has_gjk(spec: Spec) -> bool:
    """Whether distances of convex bodies are looked for by GJK."""
    ahead = spec.has("speculative") and spec.collides(box_box.PAIR.name)
    return has_epa(spec) or ahead or (spec.has("fast_bodies") and needs_separation(spec))


@inner
def forget_limits(scratch):
    """Forget what was counted in a part of the step that is begun anew."""
    counted = scratch.not_converged[0]
    counted.gjk, counted.epa = 0, 0


@once
def make_count_limits(spec: Spec):
    """Return `kernel(scratch, counters)`: `counters` tells of the step so far."""

    def count_limits(scratch, counters):
        counted = scratch.not_converged[0]
        counters.gjk_not_converged += counted.gjk
        counters.epa_not_converged += counted.epa
        forget_limits(scratch)

    return kernel(count_limits, spec)
