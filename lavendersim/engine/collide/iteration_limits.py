"""Searches on shapes that may take all their iterations, and which engines have them.

GJK and EPA, the ascent to a depth of round cores, the advance of fast bodies and the time of an
impact. Such a call gives what it found so far, as if it had ended by its tolerance; the step says
how many there were (`gjk_not_converged` and so on of /step; `limit_counts`). Columns of the log
follow from this, so it loads without numba.
"""

from __future__ import annotations

from ..effects import has_hook
from ..row_terms import row_terms
from ..spec import Spec
from ..step_terms import step_terms
from .pairs import SHAPE_PAIRS
from .shapes import has_curved

# Files of `pairs` whose kernels look for a depth by EPA.
OF_EDGES = tuple(
    f"{shape}_mesh" for shape in ("box", "capsule", "cylinder", "hull", "ellipsoid", "cone")
)
BY_EPA = ("convex", "ellipsoid_convex", *OF_EDGES)


def needs_separation(spec: Spec) -> bool:
    """Whether a pair has a gap that its points do not hold."""
    pairs = [SHAPE_PAIRS[name] for name in spec.shape_pairs]
    return not all(pair.closed_form or not pair.convex for pair in pairs)


def has_epa(spec: Spec) -> bool:
    """Whether depths of convex bodies are looked for by EPA, from where GJK ends."""
    return any(SHAPE_PAIRS[name].file in BY_EPA for name in spec.shape_pairs)


def has_gjk(spec: Spec) -> bool:
    """Whether distances of convex bodies are looked for by GJK."""
    ahead = step_terms(spec).ahead and spec.collides("box_box")
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
