"""Joint: two bodies move only as it lets them relative to each other, whatever pulls or pushes.

    n . (x_B - x_A) = 0,    n . (v_B - v_A) = 0        of two points, in the direction of each row
A ball joint has three rows of its point, along the axes of the world. A hinge has two more, of a
point further along its axis, across that axis; a fixed joint has a sixth, of a point beside it. A
slider has its rows across its axis alone: two of each of two points along it, one beside it.
Rows across an axis are along directions that turn with A.

Each row has no cone: its impulse may have either sign, and no law but the equation holds for it.
The rows stand among those of contacts and are solved, carried to the middle of the step and
projected with them: one after the other by sweeps, all at once by Newton's method.

    w = n . (v_B - v_A) + target = 0,    lambda_n <- lambda_n - w/k_n

At the middle of the step (`contact_midpoint`) it is the mean velocity that has none along the rows,
with the levers of the mean of both ends of the step (`joint_turn`): what they do is no work, and
the points stay together. What other steps leave is projected back, all of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..records import Field
from ..spec import Spec
from ..step_terms import step_terms
from ..terms import RowTerms
from .decision import Decision, Facts, named
from .effect import Column, Effect, Fields, Hooks, Kernel, kernel
from .joint_models import holding


def decide(facts: Facts) -> Decision:
    """On when a joint holds a body that moves."""
    joints = holding(facts.scene) if facts.scene is not None else {}
    if joints:
        return Decision(True, f"{named([one.name_of_pair for one in joints.values()])}: a joint")
    return Decision(False, "no joint holds a body that moves")


# Solvers whose sweeps take rows without a cone.
SOLVERS = ("adaptive", "projected_gauss_seidel")
IMPACTS = ("in_order", "captured")
MOVES = ("teleport", "orientation")  # of an event: at once, whatever joints there are


def excludes(config: Any) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield what of a cell its joints cannot be with yet."""
    joints = holding(config.scene)
    if not joints:
        return
    numerics, has = config.numerics, "the scene has joints"
    if numerics.solver not in SOLVERS:
        expected = " or ".join(SOLVERS)
        sentence = f"{has}, which {numerics.solver} does not solve; expected {expected}"
        yield ("numerics", "solver"), sentence
    if numerics.impacts not in IMPACTS:
        sentence = f"{has}, which {numerics.impacts} may tear; expected {' or '.join(IMPACTS)}"
        yield ("numerics", "impacts"), sentence
    if numerics.impacts == "in_order" and numerics.simultaneous_impacts != "together":
        sentence = f"{has}, which pass impacts on at once; expected together"
        yield ("numerics", "simultaneous_impacts"), sentence
    if numerics.sleeping:
        yield ("numerics", "sleeping"), f"{has}, and what they hold does not sleep; leave it out"
    if config.scene.springs and numerics.integrator != "midpoint_contact":
        sentence = (
            f"{has} and springs, which only midpoint_contact finds together; "
            "expected midpoint_contact"
        )
        yield ("numerics", "integrator"), sentence
    if config.study.mistake != "none":
        yield ("study", "mistake"), f"{has}, which have none; leave it out"
    if config.record.problems != "none":
        sentence = f"{has}, and a contact problem has cones alone; leave it out"
        yield ("record", "problems"), sentence
    joined = {name for one in joints.values() for name in one.between}
    for k, event in enumerate(config.planned_events):
        for key in MOVES:
            if getattr(event, "body", None) in joined and getattr(event, key) is not None:
                sentence = f"{event.body} has a joint, which this would tear; leave it out"
                yield ("events", k, key), sentence


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its column of a contact."""
    from ..collide.joint import number_of
    from ..row_terms import row_terms

    stopped = row_terms(spec).stopped

    def log_joint(out, contact, va, vb):
        of_joint = contact.bilateral == 1  # no feature tells: those of surfaces may be as large
        if stopped:
            of_joint = of_joint or contact.stop == 1
        out.joint = number_of(contact.feature) if of_joint else 0

    return kernel(log_joint, spec)


def contact_fields(spec: Spec) -> list[Field]:
    """Return the levers of a row, where impulses turn bodies, and those of the step's start."""
    from ..row_terms import row_terms

    centred = step_terms(spec).centred
    fields = []
    if centred:
        # How fast its ends part as the step begins [m/s].
        fields += [(f"parting_{axis}", "f8") for axis in "xyz"]
        fields.append(("torn", "i8"))  # 1: they are torn (`midpoint_rows`); -1: not known yet
    if row_terms(spec).levers:
        # From the centre of each body to where the joint is on it [m]; at the middle: `joint_turn`.
        arms = ("arm", "at_arm") if centred else ("arm",)
        fields += [
            (f"{name}_{body}{axis}", "f8") for name in arms for body in "ab" for axis in "xyz"
        ]
        fields += [(f"apart_{axis}", "f8") for axis in "xyz"]  # B's end from A's, at the start [m]
        fields.append(("sliding", "i8"))  # 1: its ends slide across its direction, which is of A
        fields += [(f"free_{axis}", "f8") for axis in "xyz"]  # unit, where its ends slide; or 0
    return fields


EFFECT = Effect(
    name="joint",
    decide=decide,
    per="contact",
    needs=("compound", "frictionless_contact"),
    excludes=excludes,
    row=RowTerms(frictionless=True, bilateral=True),
    fields=Fields(
        contact=[("bilateral", "i8")],  # 1: of a joint, a row without a cone
        contact_with=contact_fields,
    ),
    contact_columns=(
        Column("joint", "i8", "number of the joint that it is a row of, from 1; 0: none"),
    ),
    hooks=Hooks(contact_row=make_contact_row),
)
