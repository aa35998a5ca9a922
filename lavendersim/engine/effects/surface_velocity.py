"""Surface velocity: a surface that moves along itself under friction, as a conveyor's belt does.

    s = R_B s_B - R_A s_A,   slip += (t1 . s, t2 . s)
s_A, s_B in the bodies' frames [m/s]. Its part along the normal says nothing and is left out.
"""

from typing import Any

from lavendersim.quantities.quantity import Vector3, Velocity

from ..records import ORIENTED_BODY
from ..terms import RowTerms
from .decision import Decision, Facts, named
from .effect import Balance, Effect, Fields, Hooks, Unlogged, kernel
from .keys import BodyKey, Turn


def resolve(value: Vector3, turn: Turn) -> Vector3:
    """Return the velocity in the frame of the principal axes."""
    return turn(value)


def body_values(body: Any) -> dict[str, float]:
    """Return the values of the body fields of its own that a config states for a body."""
    return dict(zip(("sx", "sy", "sz"), body.surface_velocity, strict=True))


def decide(facts: Facts) -> Decision:
    """On when a surface moves and some contact has friction."""
    moving = [
        body.name for body in facts.bodies if any(any(one.surface_velocity) for one in body.forms)
    ]
    if not moving:
        return Decision(False, "no surface moves in its body")
    if any(pair.surface.friction > 0.0 for pair in facts.pairs):
        return Decision(True, f"{named(moving)}: the surface moves")
    return Decision(False, f"{named(moving)}: the surface moves, but nothing has friction")


def make(spec):
    """Return `kernel(contact, body_a, body_b)`, once its tangents are set."""
    from ..rotation import to_world

    def surface_velocity(contact, body_a, body_b):
        ax, ay, az = to_world(body_a, body_a.sx, body_a.sy, body_a.sz)
        bx, by, bz = to_world(body_b, body_b.sx, body_b.sy, body_b.sz)
        x, y, z = bx - ax, by - ay, bz - az
        contact.surface_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        contact.surface_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z

    return kernel(surface_velocity, spec)


EFFECT = Effect(
    name="surface_velocity",
    decide=decide,
    per="contact",
    row=RowTerms(shifted=True),
    needs=("friction",),
    body_keys=(
        BodyKey(
            name="surface_velocity",
            type=Velocity,
            default=(0.0, 0.0, 0.0),
            doc="[m/s] of the surface in the body's frame, as of a conveyor's belt; what of it "
            "lies along a contact's normal says nothing",
            resolve=resolve,
            by_event=True,
        ),
    ),
    balance=Balance(
        unlogged=Unlogged("energy", "the surface of {body} moves by itself, and its work")
    ),
    fields=Fields(
        body=[*ORIENTED_BODY, ("sx", "f8"), ("sy", "f8"), ("sz", "f8")],  # body's frame [m/s]
        contact=[
            ("surface_1", "f8"),  # of B's surface in B relative to A's in A, along t1 [m/s]
            ("surface_2", "f8"),
        ],
    ),
    body_values=body_values,
    hooks=Hooks(surface_velocity=make),
)
