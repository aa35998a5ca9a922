"""Error control: substeps as long as the accuracy asked for allows, by step doubling.

A substep is made twice from the same state: whole, and in two halves. What both lead to differs by
    |whole - halves| ~ (2^p - 1) e,     p = 2 the order of the step,
so e, the estimated error of the halves, is a third of it (Richardson's extrapolation, as in
Wolfram's method DoubleStep). The halves are kept when e is small enough, else all of it is taken
back and made again, shorter. `error_estimate` says what e is relative to.

The error of a run is to be `accuracy`. Estimates add up without cancelling, so that those of a
substep of h of a run of T may be 3 accuracy h/T. At a kink (a stick that ends, a spring that is
left) no length makes a step of second order; there e may be a share of what the substeps before
have left unspent, and the substep gets shorter until it is. One that had to be shorter than
`smallest_timestep` ends the run.

Within a substep impacts happen at their own times, as ever (`impact_order`), and each part between
them is made in halves: one that both ways share would have no estimate. The timestep is the longest
substep, and what the log has rows of: substeps end where a step ends, and where a function of time
bends or jumps. Round bodies that keep their spin, and kinematic ones, turn exactly (`body_turn`).
"""

from __future__ import annotations

from typing import Any

from ..spec import Spec
from ..terms import StepTerms
from .decision import Decision, Facts
from .effect import Choice, Column, Effect, Fields, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for an accuracy and something moves."""
    if facts.accuracy is None:
        return Decision(False, "no accuracy is asked for: every step is one timestep long")
    if not any(body.movable for body in facts.bodies):
        return Decision(False, "nothing moves")
    return Decision(True, f"an accuracy of {facts.accuracy:g} is asked for")


def make_step_row(spec: Spec) -> Any:
    """Return `kernel(row, bodies, counters)` that fills its columns of a step."""

    def log_substeps(row, bodies, counters):
        row.substeps, row.rejected = counters.substeps, counters.rejected
        row.shortest, row.estimated_error = counters.shortest, counters.estimated_error

    return kernel(log_substeps, spec)


EFFECT = Effect(
    name="error_control",
    decide=decide,
    per="body",
    chosen_by=Choice("accuracy", examples=(1e-3, None)),
    step=StepTerms(substeps=True),
    fields=Fields(
        parameters=[
            ("accuracy", "f8"),  # error that the run may have, relative [-]
            ("smallest_timestep", "f8"),  # no substep is shorter [s]
            ("duration", "f8"),  # of the run [s]
        ],
    ),
    step_columns=(
        Column("substeps", "i8", "substeps that the step was made in", number=36),
        Column("rejected", "i8", "substeps that were taken back", number=37),
        Column("shortest", "f8", "length of the shortest substep", "s", number=38),
        Column(
            "estimated_error",
            "f8",
            "sum of the estimated errors of the substeps",
            number=39,
        ),
    ),
    hooks=Hooks(step_row=make_step_row),
)
