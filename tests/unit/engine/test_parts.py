"""A step made in parts counts what its parts did, and the next begins with nothing."""

from __future__ import annotations

import numpy as np
from interpreted import interpreted, records

from lavendersim.engine import parts
from lavendersim.engine.approach import NEVER
from lavendersim.engine.records import COUNTERS, dtype
from lavendersim.engine.spec import Spec


def counters():
    return records(np.zeros(1, dtype(COUNTERS)))[0]


def test_counts_are_sums_and_what_one_part_did_not_reach_the_step_did_not() -> None:
    gather, own = interpreted(parts.make_gather_parts(Spec())), counters()
    done = [(3, 0, 1), (5, 1, 0), (2, 0, 0)]
    for sweeps, not_converged, stronge in done:
        own.sweeps, own.not_converged, own.stronge = sweeps, not_converged, stronge
        gather(own)
    assert (own.parts, own.sweeps, own.not_converged, own.stronge) == (3, 10, 1, 1)


def test_the_next_step_begins_with_no_part_and_keeps_the_rest() -> None:
    own = counters()
    fields = [name for name, _ in COUNTERS]
    for k, name in enumerate(fields):
        setattr(own, name, k + 1)
    interpreted(parts.make_end_step(Spec()))(own)
    zero = {"elapsed", "substeps", "rejected", "shortest", "estimated_error", "parts", "spent"}
    zero |= {
        "unordered",
        "plastic",
        "part_sweeps",
        "part_not_converged",
        "part_unordered",
        "part_stronge",
    }
    for k, name in enumerate(fields):
        expected = 0 if name in zero else NEVER if name == "met_at" else k + 1
        assert getattr(own, name) == expected, name


def test_sweeps_of_the_step_that_is_made_again_are_forgotten_and_no_others() -> None:
    rows = np.zeros(6, dtype([("step", "i8")]))
    rows["step"] = [3, 4, 4, 5, 5, 5]
    for effects, left in ((("residual_log",), 3), ((), 6)):
        own = counters()
        own.step, own.residual_rows = 4, 6
        interpreted(parts.make_forget_history(Spec(effects)))(own, records(rows))
        assert own.residual_rows == left
    rows["step"] = 5
    own = counters()
    own.step, own.residual_rows = 4, 6
    interpreted(parts.make_forget_history(Spec(("residual_log",))))(own, records(rows))
    assert own.residual_rows == 0


def test_steps_have_parts_with_ordered_impacts_or_error_control() -> None:
    assert parts.has_parts(Spec(("impact_order",)))
    assert parts.has_parts(Spec(("error_control",)))
    assert not parts.has_parts(Spec(("midpoint",)))
