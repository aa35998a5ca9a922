"""Least norm: where forces are undetermined, redundant contacts have those of equal compliances.

Four legs of a rigid table carry what one equation too few says: any solver's choice moves the table
alike. Of all impulses that do, a step then has the ones of least sum of squares. They are unique,
hence as symmetric as the scene, and the limit of contacts that all give way alike; see
`solvers.newton.least_norm`. Steps whose sweeps hardly change an impulse keep those of before.
"""

from typing import Any, Final

from ..records import Field
from ..spec import Spec
from . import newton
from .decision import Decision, Facts
from .effect import Choice, Column, Effect, Fields, Hooks, kernel

# Each choice factorises a matrix over all bodies that touch: where more move, as solved.
MOST_BODIES: Final = 50


def is_affordable(facts: Facts) -> bool:
    """Whether few enough bodies move."""
    return sum(body.movable for body in facts.bodies) <= MOST_BODIES


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it, Newton's method is there, and few bodies move."""
    if facts.undetermined_forces != "least_norm":
        return Decision(False, f"undetermined_forces is {facts.undetermined_forces}")
    solved = newton.decide(facts)
    if not solved.on:
        return solved
    shapes = {body.name: body.shape for body in facts.bodies}
    pair = facts.pairs[0]
    if facts.pair_count == 1 and {shapes[pair.a], shapes[pair.b]} <= newton.ONE_POINT:
        return Decision(False, f"{pair.a} and {pair.b} touch in one point")
    if not is_affordable(facts):
        moving = sum(body.movable for body in facts.bodies)
        return Decision(False, f"{moving} bodies move, more than {MOST_BODIES}")
    return Decision(True, "redundant contacts have the impulses of least norm")


def make(spec: Spec) -> Any:
    """Return `kernel(system, workspace, params, counters)`."""
    from ..solvers.newton.least_norm import make_least_norm

    return make_least_norm(spec)


def make_step_row(spec: Spec) -> Any:
    """Return `kernel(row, bodies, counters)` that says how often no least norm was found."""

    def log_not_found(row, bodies, counters):
        row.least_norm_not_converged = counters.least_norm_not_converged

    return kernel(log_not_found, spec)


def contact_fields(spec: Spec) -> list[Field]:
    """Return the columns of the face of Coulomb's cone that a contact's impulse is on."""
    from ..row_terms import row_terms

    sliding = [
        *[("slip_1", "f8"), ("slip_2", "f8")],  # of the solve [m/s]
        *[("given_1", "f8"), ("given_2", "f8")],  # friction of what slides, given for a round [N s]
    ]
    # See `solvers.newton.faces`.
    return [("face", "i8"), *(sliding if row_terms(spec).frictional else ())]


EFFECT = Effect(
    name="least_norm",
    decide=decide,
    per="contact",
    needs=("newton",),
    chosen_by=Choice("undetermined_forces"),
    fields=Fields(contact_with=contact_fields),
    counts=("least_norm_not_converged",),
    step_columns=(
        Column(
            "least_norm_not_converged",
            "i8",
            "choices of undetermined forces that took all their rounds",
            number=53,
        ),
    ),
    hooks=Hooks(choose_impulses=make, step_row=make_step_row),
)
