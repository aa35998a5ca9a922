"""Contact midpoint: lasting contacts act at the middle of the step, and bodies move by the mean.

    M (v_1 - v_0) = dt f + J(q_m)^T lambda,    J(q_m) (v_0 + v_1)/2 = 0
    x_1 = x_0 + dt (v_0 + v_1)/2
q_m is the pose half way between the step's two ends, found by fixed point (`midpoint_geometry`):
normal, contact point, levers and inertia are those of q_m. The scheme is symmetric in time, hence
of order 2, and an ideal contact does no work in it: lambda . J(q_m) (v_0 + v_1)/2 = 0.
A row asks this of v_1:
    J(q_m) v_1 + b = 0,   b = J(q_m) v_0 - J(q_0) v_0
J(q_0) v_0 is what v_0 violates the contact by at the start. Where that approaches it is left out of
the mean, or the step would return it with the opposite sign, and so for ever (the midpoint rule's
undamped mode); what parts stays in, so that no contact does positive work. Of a contact that slides
throughout, friction is against the mean slip: there b_t = J_t(q_m) v_0.

A contact lasts when it is closed and its surfaces do not approach as the step begins; bodies that
meet in a step move by v_1, as ever (`integrate`). Where nothing turns q_m has the geometry of q_0.
"""

from __future__ import annotations

from ..records import Field
from ..spec import Spec
from ..terms import RowTerms, StepTerms
from .decision import Decision, Facts
from .effect import Choice, Column, Effect, Fields, Hooks, Kernel, kernel


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and something can touch."""
    if facts.integrator != "midpoint_contact":
        return Decision(False, f"the integrator is {facts.integrator}")
    if not facts.pairs:
        return Decision(False, "nothing can touch")
    return Decision(True, "integrator is midpoint_contact and bodies can touch")


def contact_fields(spec: Spec) -> list[Field]:
    """Return the columns of frictional and of swept contacts."""
    from ..row_terms import row_terms

    swept = [("at_tx", "f8"), ("at_ty", "f8"), ("at_tz", "f8")] if row_terms(spec).swept else []
    if not row_terms(spec).frictional:
        return swept
    torques = [("kept_psi_n", "f8"), ("kept_psi_1", "f8"), ("kept_psi_2", "f8")]
    return [
        *swept,
        *[("kept_1", "f8"), ("kept_2", "f8")],  # along the tangents
        *(torques if row_terms(spec).torsional or row_terms(spec).rolling else ()),
        ("surface_1", "f8"),  # added to the slip of the row: of moving surfaces, and b_t [m/s]
        ("surface_2", "f8"),
        *[(f"begin_{axis}", "f8") for axis in "xyz"],  # slip at the start, moving surfaces included
        ("slides", "i8"),  # above 0: friction is to be against the mean slip; 2: the row says so
    ]


def make_step_row(spec: Spec) -> Kernel:
    """Return `kernel(row, bodies, counters)` that says how often no middle was found."""

    def log_not_found(row, bodies, counters):
        row.midpoint_not_converged = counters.midpoint_not_converged

    return kernel(log_not_found, spec)


EFFECT = Effect(
    name="contact_midpoint",
    decide=decide,
    per="contact",
    row=RowTerms(shifted=True),
    step=StepTerms(centred=True),
    chosen_by=Choice("integrator"),
    fields=Fields(
        contact=[
            ("dv_n", "f8"),  # change of v_n by forces in this step [m/s]
            ("lasts", "i8"),  # 1: closed, and not approached, as the step begins
            ("jumps", "i8"),  # 1: a body of it jumps, whatever it would do: `midpoint_jumps`
            ("begin_n", "f8"),  # n . J(q_0) v_0 [m/s]
            ("middle_n", "f8"),  # n . J(q_m) v_0 [m/s]
            ("kept_n", "f8"),  # impulse of the solve at the start [N s]
            *[(f"at_{axis}", "f8") for axis in "xyz"],  # point and normal at the start
            *[(f"at_n{axis}", "f8") for axis in "xyz"],
        ],
        contact_with=contact_fields,
    ),
    counts=("midpoint_not_converged",),
    step_columns=(
        Column(
            "midpoint_not_converged",
            "i8",
            "parts of the step whose contacts at its middle took all their passes, or were not"
            " solved there",
            number=50,
        ),
    ),
    hooks=Hooks(step_row=make_step_row),
)
