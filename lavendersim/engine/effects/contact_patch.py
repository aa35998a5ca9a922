"""Contact patch: friction of a contact area acts nearer to its middle than the points it rests on.

A flat puck of radius R rests on points of its rim, and four of them brake its spin with mu N R.
Even pressure over its face does with the mean of r, 2/3 mu N R: omega' = -4/3 mu g / R. So the
tangential impulse p of each point acts at a share q of its distance d from the middle of the area,
the mean of the points that are closed, and the normal one where it is:
    slip = v_t + e (n . omega),   psi_n = e . p,   e = (1 - q) n x d
q = 2/3 is even pressure over a disc, 3 pi/16 that of Hertz, 1 the points themselves. Slip and
angular impulse have the same e, so each point keeps Coulomb's law and maximum dissipation with a
lever of its own, at any slip and spin together, and sticks by the same law.

Forces of combined slip and spin are those of a ring of radius q R. Of even pressure over the disc,
    F(v, omega), T(v, omega) = gradient of mu N mean(|v + omega x r|)
the dissipation of the ring falls short by 3.9 % at most and that of four points on it by 1.7 to
8.8 %, by where they lie; an ellipse through the same F and T exceeds it by 7.0 % (the integral is
computed in the tests). The ring and the shares are ours. An area is the manifold of one pair of
shapes: what rests on several parts has no patch over all of them.
"""

from __future__ import annotations

from ..records import TOUCHING
from ..spec import Spec
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Column, Effect, Fields, Hooks, Kernel, kernel
from .keys import SHARE, SurfaceKey


def smaller(one: float, other: float) -> float:
    """Return the smaller of two surfaces' values."""
    return min(one, other)


def _described(pair: PairFacts) -> str:
    surface = pair.surface
    if surface.friction == 0.0 or surface.friction_reach == 1.0:
        return ""
    return f"friction at {surface.friction_reach:g} of the distance from the middle"


def decide(facts: Facts) -> Decision:
    """On when friction of a pair that may touch acts elsewhere than at its points."""
    if any(_described(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "friction acts at the points of contact")


def make_mark_middle(spec: Spec) -> Kernel:
    """Return `kernel(contacts, first, last, pair, found)`: e of each contact of a manifold.

    found: as the step begins, which says who is closed; else they have moved to its middle.
    """

    def mark_middle(contacts, first, last, pair, found):
        x, y, z, closed = 0.0, 0.0, 0.0, 0.0
        for c in range(first, last):
            contact = contacts[c]
            contact.patch_x, contact.patch_y, contact.patch_z = 0.0, 0.0, 0.0
            if found:
                contact.in_patch = 1 if contact.phi <= TOUCHING else 0
            if contact.in_patch == 1:
                x, y, z = x + contact.x, y + contact.y, z + contact.z
                closed += 1.0
        if pair.friction == 0.0 or pair.friction_reach == 1.0 or closed < 2.0:
            return
        x, y, z = x / closed, y / closed, z / closed
        share = 1.0 - pair.friction_reach
        for c in range(first, last):
            contact = contacts[c]
            if contact.in_patch == 1:
                dx, dy, dz = x - contact.x, y - contact.y, z - contact.z
                contact.patch_x = share * (contact.ny * dz - contact.nz * dy)
                contact.patch_y = share * (contact.nz * dx - contact.nx * dz)
                contact.patch_z = share * (contact.nx * dy - contact.ny * dx)

    return kernel(mark_middle, spec)


def make_contact_row(spec: Spec) -> Kernel:
    """Return `kernel(out, contact, va, vb)` that fills its column of a contact."""

    def log_patch(out, contact, va, vb):
        x = contact.t1x * contact.lambda_1 + contact.t2x * contact.lambda_2
        y = contact.t1y * contact.lambda_1 + contact.t2y * contact.lambda_2
        z = contact.t1z * contact.lambda_1 + contact.t2z * contact.lambda_2
        out.patch_impulse_n = contact.patch_x * x + contact.patch_y * y + contact.patch_z * z

    return kernel(log_patch, spec)


EFFECT = Effect(
    name="contact_patch",
    decide=decide,
    per="contact",
    needs=("friction",),
    row=RowTerms(coupled=True),
    surface_keys=(
        SurfaceKey(
            name="friction_reach",
            type=SHARE,
            default=1.0,
            doc="share of its distance from the middle of a contact area at which a point has its "
            "friction, 2/3: even pressure over a disc, 1: at the point; a pair takes the smaller",
            mix=smaller,
            needs="friction",
        ),
    ),
    fields=Fields(
        pair=[("friction_reach", "f8")],  # q [-]
        contact=[
            ("patch_x", "f8"),  # e, world axes: an impulse p turns about n by e . p [m]
            ("patch_y", "f8"),
            ("patch_z", "f8"),
            ("in_patch", "i8"),  # 1: closed as the step begins
            ("at_patch_x", "f8"),  # e as the step begins [m]
            ("at_patch_y", "f8"),
            ("at_patch_z", "f8"),
        ],
    ),
    contact_columns=(
        Column(
            "patch_impulse_n",
            "f8",
            "angular impulse on B about the normal, beside that of the impulse at the point",
            "N m s",
        ),
    ),
    hooks=Hooks(mark_middle=make_mark_middle, contact_row=make_contact_row),
)
