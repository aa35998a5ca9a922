"""Compounds: bodies of several parts. Parts collide; contacts act on the body that owns them.

    x = X + R p,   q = Q p_q        part (x, q), owner (X, Q), place in the owner's frame (p, p_q)
Parts are rows of the body table behind all bodies; every other row is its own owner. The ends of
ropes are parts that touch nothing.
"""

from math import sqrt

from ..records import ORIENTED_BODY
from .decision import Decision, Facts, named
from .effect import Effect, Fields, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when a body has parts."""
    whole = [body.name for body in facts.bodies if body.parts]
    if whole:
        return Decision(True, f"{named(whole)}: made of parts")
    if any(pair.shape_pair == "rope" for pair in facts.pairs):
        return Decision(True, "ends of ropes are tied to bodies, and follow them")
    if any(pair.shape_pair == "joint" for pair in facts.pairs):
        return Decision(True, "ends of joints are tied to bodies, and follow them")
    return Decision(False, "every body is one shape")


def make_place_part(spec):
    """Return `kernel(bodies, i)`: a part follows its owner; a body that has none stays."""
    from ..rotation import orient, to_world

    def place_part(bodies, i):
        part = bodies[i]
        if part.owner != i:
            whole = bodies[part.owner]
            x, y, z = to_world(whole, part.px, part.py, part.pz)
            part.x, part.y, part.z = whole.x + x, whole.y + y, whole.z + z
            a, b, c, d = whole.qw, whole.qx, whole.qy, whole.qz
            w, x, y, z = part.pqw, part.pqx, part.pqy, part.pqz
            qw = a * w - b * x - c * y - d * z
            qx = a * x + b * w + c * z - d * y
            qy = a * y - b * z + c * w + d * x
            qz = a * z + b * y - c * x + d * w
            scale = 1.0 / sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
            part.qw, part.qx, part.qy, part.qz = qw * scale, qx * scale, qy * scale, qz * scale
            orient(part)

    return kernel(place_part, spec)


def make(spec):
    """Return `kernel(bodies)`: parts follow their owners."""
    place_part = make_place_part(spec)

    def place_parts(bodies):
        for i in range(bodies.shape[0]):
            place_part(bodies, i)

    return kernel(place_parts, spec)


EFFECT = Effect(
    name="compound",
    decide=decide,
    per="body",
    fields=Fields(
        body=[
            *ORIENTED_BODY,
            ("owner", "i8"),  # row of the body that moves
            ("px", "f8"),  # part: its centre in the owner's frame [m]
            ("py", "f8"),
            ("pz", "f8"),
            ("pqw", "f8"),  # part to owner
            ("pqx", "f8"),
            ("pqy", "f8"),
            ("pqz", "f8"),
        ],
    ),
    hooks=Hooks(place_parts=make, place_part=make_place_part),
)
