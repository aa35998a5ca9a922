"""Tangential restitution: an impact gives back a share of its slip, as a superball does.

    s' = -e_t s,   |lambda_t| <= mu lambda_n
s: slip of the two surfaces as they meet, s' as they part. The speed along the surface of a ball of
I = b m R^2 changes by -(1 + e_t) b/(1 + b) s: with e_t = 1 a solid one (b = 2/5) without spin
leaves with 3/7 of it, and after the next bounce has all of it again. That slip is reversed and
energy kept is Garwin's superball (1969; cited as background, not opened); the forms above follow
from the two balances of momentum.

The row asks v_t + e_t s = 0, as it would of a belt of velocity e_t s (`surface_velocity`), so no
solver knows of it: what the cone cannot give back stays slip. Contacts that last are no impacts,
nor is what meets by no more than round-off, and e_t = 0 is friction alone. The slip that is logged
has e_t s added, as a belt's. A point off the line of centres may win energy by it, as by Newton's
law; where Stronge's takes that one's place (`impact_energy`), its friction gives back no slip.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..spec import Spec
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Effect, Fields, Hooks, Kernel, kernel
from .keys import SHARE, SurfaceKey, larger

WITHOUT_ORDER = {
    "captured": "which lasting contact has too",
    "at_surface": "where bounces within a step are one",
}


def _described(pair: PairFacts) -> str:
    e = pair.surface.tangential_restitution
    return f"gives back {e:g} of the slip" if e > 0.0 and pair.surface.friction > 0.0 else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch gives back slip, and has friction to do it by."""
    if any(_described(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "no pair that may touch gives back slip")


def excludes(config: Any) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield impacts without order: captured ones do not tell an impact from a contact that lasts.

    At the surface, or with a stabilisation gain, bounces of a step count as one, and each of them
    reverses the slip that the one before it left.
    """
    numerics = config.numerics
    if numerics.impacts != "in_order":
        why = f"impacts are {numerics.impacts}, {WITHOUT_ORDER[numerics.impacts]}"
    elif numerics.stabilisation_gain > 0.0:
        why = "stabilisation_gain is above 0, so impacts have no order"
    else:
        return
    for name, body in config.scene.bodies.items():
        own = (body.surface, *getattr(body.surface, "partners", ()))
        if any((one.tangential_restitution or 0.0) > 0.0 for one in own):
            place = ("scene", "bodies", name, "surface", "tangential_restitution")
            yield place, f"{why}; expected 0, or impacts in_order"


def make_reverse_slip(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, va, vb)`, of any contact, before impulses act."""
    from ..approach import CREEP
    from ..block import make_slip_velocity

    slip_velocity = make_slip_velocity(spec)

    def reverse_slip(contact, pair, va, vb):
        contact.reversed_1, contact.reversed_2 = 0.0, 0.0
        if contact.is_impact == 0 or contact.approach_speed <= CREEP:
            return
        _, one, two = slip_velocity(contact, va, vb)
        contact.reversed_1 = pair.tangential_restitution * one
        contact.reversed_2 = pair.tangential_restitution * two
        contact.surface_1 += contact.reversed_1
        contact.surface_2 += contact.reversed_2

    return kernel(reverse_slip, spec)


EFFECT = Effect(
    name="tangential_restitution",
    decide=decide,
    per="contact",
    needs=("friction",),
    excludes=excludes,
    row=RowTerms(shifted=True),
    surface_keys=(
        SurfaceKey(
            name="tangential_restitution",
            type=SHARE,
            default=0.0,
            doc="share of the slip given back by impacts, as far as friction can, 0 to 1; a pair "
            "takes the larger",
            mix=larger,
            needs="friction",
        ),
    ),
    fields=Fields(
        pair=[("tangential_restitution", "f8")],  # e_t [-]
        contact=[
            ("surface_1", "f8"),  # added to the slip along t1 [m/s]
            ("surface_2", "f8"),
            ("reversed_1", "f8"),  # what of it is e_t times the slip before [m/s]
            ("reversed_2", "f8"),
        ],
    ),
    hooks=Hooks(reverse_slip=make_reverse_slip),
)
