"""Joint: a point of one body and a point of another stay together, whatever pulls or pushes.

    r = x_B - x_A = 0,    v_B - v_A = 0        of the two points, in three directions of the world
Each direction is a row without a cone: its impulse may have either sign, and no law but the
equation holds for it. The rows stand among those of contacts and are solved, carried to the middle
of the step and projected with them: one after the other by sweeps, all at once by Newton's method.

    w = n . (v_B - v_A) + target = 0,    lambda_n <- lambda_n - w/k_n

At the middle of the step (`contact_midpoint`) it is the mean velocity that has none along the rows,
with the levers of the mean of both ends of the step (`joint_turn`): what they do is no work, and
the points stay together. What other steps leave is projected back, all of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field as ModelField
from pydantic import Strict

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import Quantity, Vector, Vector3

from ..records import Field
from ..spec import Spec
from .decision import Decision, Facts, named
from .effect import Column, Effect, Fields, Hooks, Kernel, RowTerms, kernel

_Point = Annotated[Vector3, Vector(3, Quantity("m"))]
# In a cell's JSON they are lists.
_Names = Annotated[tuple[BodyName, ...], Strict(False), ModelField(min_length=2, max_length=2)]
AXES = 3  # rows of a ball joint


class BallJoint(ConfigModel):
    """A ball joint: two bodies share a point, about which they turn freely."""

    kind: Literal["ball"] = ModelField(description="`ball`")
    between: _Names = ModelField(description="names of two bodies, of which at least one moves")
    at: _Point = ModelField(description="[m] the point that they share, as the run begins")
    collide: bool = ModelField(
        default=False, description="whether the two bodies also touch each other"
    )

    @classmethod
    def rules(cls, at: Any) -> None:
        """It joins two bodies."""
        names = [one.text for one in at.get("between").items]
        if len(names) == 2 and names[0] is not None and names[0] == names[1]:
            sentence = f'"{names[0]}" twice; expected two bodies'
            at.refuse(at.get("between").mark, f"between: {sentence}")

    @property
    def name_of_pair(self) -> str:
        """Return its bodies, for a sentence."""
        return " and ".join(self.between)


def holding(scene: Any) -> Mapping[str, BallJoint]:
    """Return the joints of a scene that hold a body that moves, by name; in the file's order."""
    return {
        name: one
        for name, one in scene.connections.items()
        if isinstance(one, BallJoint)
        if not all(scene.bodies[body].fixed for body in one.between)
    }


def turned_by_joints(scene: Any) -> Iterator[str]:
    """Yield the movable bodies that a joint holds beside their centre of mass."""
    for one in holding(scene).values():
        for name in one.between:
            body = scene.bodies[name]
            if not body.fixed and tuple(body.position) != tuple(one.at):
                yield name


def decide(facts: Facts) -> Decision:
    """On when a joint holds a body that moves."""
    joints = holding(facts.scene) if facts.scene is not None else {}
    if joints:
        return Decision(True, f"{named([one.name_of_pair for one in joints.values()])}: a joint")
    return Decision(False, "no joint holds a body that moves")


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its column of a contact."""
    from ..collide.joint import number_of

    def log_joint(out, contact, va, vb):
        out.joint = number_of(contact.feature) if contact.bilateral == 1 else 0

    return kernel(log_joint, spec)


def contact_fields(spec: Spec) -> list[Field]:
    """Return the levers of a row, where impulses turn bodies, and those of the step's start."""
    from ..row_terms import row_terms

    centred = spec.has("contact_midpoint")
    fields = []
    if centred:
        fields.append(("begin_torn", "f8"))  # how fast its ends part as the step begins [m/s]
    if row_terms(spec).levers:
        # From the centre of each body to where the joint is on it [m]; at the middle: `joint_turn`.
        arms = ("arm", "at_arm") if centred else ("arm",)
        fields += [
            (f"{name}_{body}{axis}", "f8") for name in arms for body in "ab" for axis in "xyz"
        ]
    return fields


EFFECT = Effect(
    name="joint",
    decide=decide,
    per="contact",
    needs=("compound", "frictionless_contact"),
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
