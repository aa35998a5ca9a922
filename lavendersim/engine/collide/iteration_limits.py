"""Searches on shapes that took all their iterations: which engines have them, and their counts.

GJK and EPA, the ascent to a depth of round cores, the advance of fast bodies and the time of an
impact. Such a call gives what it found so far, as if it had ended by its tolerance; the step says
how many there were (`gjk_not_converged` and so on of /step).
"""

from __future__ import annotations

from ..compile import inner, kernel, once
from ..effects import has_hook
from ..row_terms import row_terms
from ..spec import Spec
from ..step_terms import step_terms
from .pairs import SHAPE_PAIRS, box_box, convex
from .shapes import has_curved
from .swept import needs_separation


def has_epa(spec: Spec) -> bool:
    """Whether depths of convex bodies are looked for by EPA, from where GJK ends."""
    return any(SHAPE_PAIRS[name].make is convex.make for name in spec.shape_pairs)


def has_gjk(spec: Spec) -> bool:
    """Whether distances of convex bodies are looked for by GJK."""
    ahead = step_terms(spec).ahead and spec.collides(box_box.PAIR.name)
    return has_epa(spec) or ahead or (row_terms(spec).swept and needs_separation(spec))


def has_ascent(spec: Spec) -> bool:
    """Whether EPA's depths of round cores are improved."""
    return has_epa(spec) and has_curved(spec)


def has_advance(spec: Spec) -> bool:
    """Whether fast bodies are moved to where they meet."""
    return row_terms(spec).swept


def has_limits(spec: Spec) -> bool:
    """Whether there is anything to count."""
    return has_gjk(spec) or has_advance(spec) or has_hook(spec, "order_impacts")


def limits_of(spec: Spec) -> list[str]:
    """Return the counters of searches that come with shapes alone; effects name their own."""
    searches = {
        "gjk_not_converged": has_gjk,
        "epa_not_converged": has_epa,
        "ascent_not_converged": has_ascent,
    }
    return [name for name, has in searches.items() if has(spec)]


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
