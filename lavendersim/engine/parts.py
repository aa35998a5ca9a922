"""A step made in parts: its counts are the sums of theirs (`impact_order`, `error_control`)."""

from __future__ import annotations

from typing import Any

from .approach import NEVER
from .compile import kernel
from .effects import has_hook
from .spec import Spec
from .step_terms import step_terms


def has_parts(spec: Spec) -> bool:
    """Whether the steps of an engine are made in parts."""
    return step_terms(spec).ordered_impacts or step_terms(spec).substeps


def make_gather_parts(spec: Spec) -> Any:
    """Return `kernel(counters)`, after a part: `counters` tells of the step so far."""

    def gather(counters):
        counters.parts += 1
        counters.part_sweeps += counters.sweeps
        counters.part_not_converged |= counters.not_converged
        counters.part_stronge |= counters.stronge
        counters.sweeps = counters.part_sweeps
        counters.not_converged = counters.part_not_converged
        counters.stronge = counters.part_stronge

    return kernel(gather, spec)


def make_forget_history(spec: Spec) -> Any:
    """Return `kernel(counters, rows)`: a step has the sweeps of the solve that counts, the last."""
    records = has_hook(spec, "sweep_row")

    def forget_history(counters, rows):
        if records:
            while counters.residual_rows > 0:
                if rows[counters.residual_rows - 1].step != counters.step + 1:
                    break
                counters.residual_rows -= 1

    return kernel(forget_history, spec)


def make_end_step(spec: Spec) -> Any:
    """Return `kernel(counters)`: the next part is the first of a step."""

    def end_step(counters):
        counters.elapsed, counters.met_at = 0.0, NEVER
        counters.substeps, counters.rejected, counters.part_unordered = 0, 0, 0
        counters.shortest, counters.estimated_error = 0.0, 0.0
        counters.parts, counters.spent, counters.unordered = 0, 0, 0
        counters.plastic = 0
        counters.part_sweeps, counters.part_not_converged, counters.part_stronge = 0, 0, 0

    return kernel(end_step, spec)
