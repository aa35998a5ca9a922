"""What ran out of iterations is counted over all parts of a step."""

from __future__ import annotations

from interpreted import interpreted, records

from lavendersim.engine.collide.iteration_limits import (
    has_advance,
    has_ascent,
    has_epa,
    has_gjk,
)
from lavendersim.engine.collide.limit_counts import make_count_limits
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.memory import allocate_counters
from lavendersim.engine.spec import Spec

AHEAD = ("speculative", "midpoint", "fast_bodies")


def test_a_step_counts_what_ran_out_in_all_its_parts() -> None:
    spec = Spec((*AHEAD, "impact_order"), ("cylinder_hull",))
    assert all(has(spec) for has in (has_gjk, has_epa, has_ascent, has_advance))
    names = ("gjk", "epa", "ascent", "advance", "impact")
    scratch, counters = allocate_scratch(None), allocate_counters()
    for part in (1, 2):
        for k, name in enumerate(names):
            scratch.not_converged[name] = part * (k + 1)
        interpreted(make_count_limits(spec))(records(scratch), records(counters)[0])
    found = [int(counters[f"{name}_not_converged"][0]) for name in names]
    assert found == [3 * (k + 1) for k in range(len(names))]
