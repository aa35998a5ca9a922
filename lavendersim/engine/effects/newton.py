"""Newton's method: solves of `adaptive` whose sweeps converge slowly are finished by it.

Two contacts that share a body trade their impulses sweep by sweep, more slowly the longer the chain
and the larger the ratio of masses. One row alone is solved by its first sweep.
"""

from ..records import Field
from ..spec import Spec
from .decision import Decision, Facts
from .effect import Choice, Effect, Fields

FORCES = [
    *[
        (f"{name}_{axis}", "f8")
        # lambda^k and the best so far [N s], contact velocities and what a step adds [m/s].
        for name in ("start", "best", "velocity", "step")
        for axis in "n12"
    ],
    ("shift", "f8"),  # De Saxce's, of this round [m/s]
    ("defect", "f8"),  # what mu |v_t| is above it [m/s]
    ("shift_change", "f8"),  # its change from the round before [m/s]
    ("scale", "f8"),  # s
    ("stiff_n", "f8"),  # e along the normal and in the tangent plane [kg]
    ("stiff_t", "f8"),
]
TORQUES = {  # by the term of rows: the same of psi, and the limits of a round [N m s]
    "torsional": [
        *[(f"{name}_n", "f8") for name in ("start_psi", "best_psi", "spin", "step_spin")],
        ("stiff_torsion", "f8"),  # e [kg m^2]
        ("limit_torsion", "f8"),
    ],
    "rolling": [
        *[
            (f"{name}_{k}", "f8")
            for name in ("start_psi", "best_psi", "spin", "step_spin")
            for k in "12"
        ],
        ("stiff_roll", "f8"),
        ("limit_roll", "f8"),
    ],
}
# Shapes that touch each other in one point, with those that they may touch in one.
ONE_POINT = {"sphere", "plane", "ellipsoid", "bowl", "drum"}


def decide(facts: Facts) -> Decision:
    """On where the solver is adaptive and some step may have two rows."""
    if facts.solver != "adaptive":
        return Decision(False, f"the solver is {facts.solver}")
    if facts.friction_cone == "pyramid":
        return Decision(False, "a pyramid of friction is no cone of revolution: sweeps solve it")
    if facts.friction_cone == "convex":
        return Decision(False, "the convex relaxation has no De Saxce's shift: sweeps solve it")
    if not facts.pairs:
        return Decision(False, "nothing can touch")
    shapes = {body.name: body.shape for body in facts.bodies}
    (pair, *others) = facts.pairs
    alone = facts.pair_count == 1 and not others
    frictional = pair.surface.friction > 0.0 or pair.resists_turning
    if alone and not frictional and {shapes[pair.a], shapes[pair.b]} <= ONE_POINT:
        return Decision(False, f"{pair.a} and {pair.b} touch in one point, without friction")
    return Decision(True, "contacts that share a body may trade impulses for many sweeps")


def contact_fields(spec: Spec) -> list[Field]:
    """Return the columns of what is on its way: impulses, and the torques that there are."""
    from ..row_terms import row_terms

    terms = row_terms(spec)
    torques = [field for term, own in TORQUES.items() if getattr(terms, term) for field in own]
    return [*FORCES, *torques]


EFFECT = Effect(
    name="newton",
    decide=decide,
    per="contact",
    chosen_by=Choice("solver"),
    fields=Fields(
        contact_with=contact_fields,
    ),
)
