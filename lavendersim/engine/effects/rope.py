"""Rope: a point of one body and a point of another are never farther apart than its length.

    phi = L - |d| >= 0,   d from A's point to B's
A taut rope is a contact without friction whose normal is its line: it pulls, and never pushes. So
its rows are those of contacts, solved, projected and judged with them; it becomes taut by an impact
in its order, and turns at the middle of the step as a lasting contact does (`collide.rope`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field as ModelField
from pydantic import Strict

from lavendersim.quantities.chosen_kind import ByKind
from lavendersim.quantities.names import BodyName, NewName
from lavendersim.quantities.quantity import Quantity, Vector, Vector3

from ..spec import Spec
from ..terms import RowTerms
from .decision import Decision, Facts, named
from .effect import Column, Effect, Fields, Hooks, Kernel, kernel
from .joint_models import AnyJoint, Connection, Joint
from .keys import SceneKey, TurnOf

_CENTRE: Vector3 = (0.0, 0.0, 0.0)
_TWO = ModelField(min_length=2, max_length=2)
_Point = Annotated[Vector3, Vector(3, Quantity("m"))]
# In a cell's JSON they are lists.
_Names = Annotated[tuple[BodyName, ...], Strict(False), _TWO]
_Points = Annotated[tuple[_Point, ...], Strict(False), _TWO]


class Rope(Connection):
    """A rope without mass between two points, each of a body: it is never longer than it is."""

    kind: Literal["rope"] = ModelField(description="`rope`")
    points: _Points = ModelField(
        default=(_CENTRE, _CENTRE),
        description="[m] where it is tied, each in the frame of its body; 0 is the centre of mass",
    )
    length: Annotated[float, Quantity("m", above=0)] | None = ModelField(
        default=None, description="[m] none: the distance of the two points as the run begins"
    )
    restitution: Annotated[float, Quantity(minimum=0, maximum=1)] = ModelField(
        default=0.0, description="[-] of the speed at which it becomes taut, what it throws back"
    )


Connections = dict[NewName, Annotated[Rope | AnyJoint, ByKind()]]


def resolve(connections: Connections, turn: TurnOf) -> Connections:
    """Return them with their points in the frames of principal axes."""
    return {
        name: one
        if isinstance(one, Joint)
        else one.model_copy(
            update={
                "points": tuple(
                    turn(body, point) for body, point in zip(one.between, one.points, strict=True)
                )
            }
        )
        for name, one in connections.items()
    }


def pulling(scene: Any) -> Mapping[str, Rope]:
    """Return the ropes of a scene that may pull a body that moves, by name; in rows' order."""
    return {
        name: one
        for name, one in scene.connections.items()
        if not isinstance(one, Joint) and any(_moves(scene.bodies[body]) for body in one.between)
    }


def _moves(body: Any) -> bool:
    return not body.fixed


def turned(scene: Any) -> Iterator[str]:
    """Yield the movable bodies whose centre of mass the line of a rope may miss."""
    for one in pulling(scene).values():
        for body, point in zip(one.between, one.points, strict=True):
            if any(point) and _moves(scene.bodies[body]):
                yield body


def decide(facts: Facts) -> Decision:
    """On when a rope ties a body that moves."""
    ropes = pulling(facts.scene) if facts.scene is not None else {}
    if ropes:
        return Decision(True, f"{named([one.name_of_pair for one in ropes.values()])}: a rope")
    return Decision(False, "no rope ties a body that moves")


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its column of a contact."""
    from ..collide.rope import FIRST_ROPE

    def log_rope(out, contact, va, vb):
        out.rope = contact.feature - FIRST_ROPE + 1 if contact.span > 0.0 else 0

    return kernel(log_rope, spec)


EFFECT = Effect(
    name="rope",
    decide=decide,
    per="contact",
    needs=("compound", "frictionless_contact"),
    scene_keys=(
        SceneKey(
            name="connections",
            type=Connections,
            default={},
            doc="name: what connects two bodies, a rope or a joint",
            resolve=resolve,
        ),
    ),
    row=RowTerms(frictionless=True, taut=True),
    fields=Fields(
        contact=[
            ("span", "f8"),  # of the row of a rope: how far its ends are apart [m]; else 0
            ("stirred", "f8"),  # and what accelerates its bodies in a timestep [m/s]
        ],
    ),
    contact_columns=(
        Column("rope", "i8", "number of the rope that it is, from 1; 0: surfaces that touch"),
    ),
    hooks=Hooks(contact_row=make_contact_row),
)
