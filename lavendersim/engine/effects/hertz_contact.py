"""Hertz contact: a spring that stiffens as it is pressed, with Hunt and Crossley's damping.

    F = k d^(3/2) (1 + a d'),   0 <= F
d is the penetration, k the pair's `hertz_stiffness`, a its `hunt_crossley_dissipation`, under the
name and in the unit that Drake has for it. k = 4/3 E sqrt(R) of two balls or a ball and a plane,
1/R = 1/R_1 + 1/R_2, 1/E = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2. Two surfaces are indented one
behind the other: k^(-2/3) = k_1^(-2/3) + k_2^(-2/3); so are two balls of equal R and E, whose k is
that of one on a rigid plane by 2^(3/2). The damping is that of Hunt and Crossley 1975 (cited as
background, not opened): no force at first touch, none that pulls, and of slow impacts a restitution
of 1 - 2/3 a v.

A step solves the law itself (`contact_spring_law`), of order 2 where bodies move by the mean of the
velocities at its ends, of order 1 elsewhere. Such a contact is a `contact_spring`: it has no
impact, so that its restitution has no effect, and it is not projected.
"""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal
from math import sqrt
from typing import Annotated, Any

from lavendersim.quantities.quantity import Quantity

from ..spec import Spec
from ..step_terms import step_terms
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Effect, Fields, Hooks, Kernel, kernel
from .keys import SurfaceKey, larger


def one_behind_the_other(one: float, other: float) -> float:
    """Return the stiffness of two surfaces, each indented by the same force; 0: it is rigid."""
    if min(one, other) == 0.0:
        return max(one, other)
    # k = k_1/(1 + (k_1/k_2)^(2/3))^(3/2)
    low, high = min(one, other), max(one, other)
    both = 1.0 + float(Decimal(low / high) ** (Decimal(2) / 3))  # the same bits on every machine
    return low / (both * sqrt(both))


def _described(pair: PairFacts[str]) -> str:
    stiffness = pair.surface.hertz_stiffness
    if not stiffness > 0.0:
        return ""
    dissipation = pair.surface.hunt_crossley_dissipation
    damped = f", damped by {dissipation:g} s/m" if dissipation > 0.0 else ""
    return f"Hertz's {stiffness:g} N/m^1.5{damped}"


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has a stiffness of Hertz's."""
    if any(_described(pair) for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "no pair that may touch has a stiffness of Hertz's")


def excludes(config: Any) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield numerics without springs at contacts, and compliances, which would act beside."""
    surfaces = {
        name: (body.surface, *getattr(body.surface, "partners", ()))
        for name, body in config.scene.bodies.items()
    }
    stiff = [
        name
        for name, own in surfaces.items()
        if any((one.hertz_stiffness or 0.0) > 0.0 for one in own)
    ]
    if not stiff:
        return
    place = ("scene", "bodies", stiff[0], "surface", "hertz_stiffness")
    if config.numerics.compliance_law != "spring":
        yield place, "compliance_law is regularised; expected 0, or the law spring"
    if config.numerics.stabilisation_gain > 0.0:
        yield place, "stabilisation_gain pushes in its place; expected 0, or no gain"
    for name, own in surfaces.items():
        if any((one.compliance or 0.0) > 0.0 for one in own):
            place = ("scene", "bodies", name, "surface", "compliance")
            yield place, f"{stiff[0]} has a hertz_stiffness, the law of all contacts; expected 0"


def make(spec: Spec) -> Kernel:
    """Return `kernel(contact, pair, params)`, behind that of `contact_spring`."""
    from ..contact_spring_law import make_touch

    touch, mean = make_touch(spec), step_terms(spec).centred

    def hertz(contact, pair, params):
        contact.hertz_stiffness = pair.hertz_stiffness
        contact.dissipation = pair.hunt_crossley_dissipation
        if pair.hertz_stiffness > 0.0:
            contact.spring_compliance = 1.0 / pair.hertz_stiffness
            contact.spring_v = contact.v_n_pre
            if mean:
                contact.spring_v -= contact.dv_n
            touch(contact, contact.v_n_pre, params)

    return kernel(hertz, spec)


EFFECT = Effect(
    name="hertz_contact",
    decide=decide,
    per="contact",
    needs=("contact_spring",),
    excludes=excludes,
    row=RowTerms(curved=True),
    surface_keys=(
        SurfaceKey(
            name="hertz_stiffness",
            type=Annotated[float, Quantity("N/m^1.5", minimum=0)],
            default=0.0,
            doc="[N/m^1.5] force per indentation to the power 1.5, 0: rigid; two surfaces are "
            "indented one behind the other",
            mix=one_behind_the_other,
        ),
        SurfaceKey(
            name="hunt_crossley_dissipation",
            type=Annotated[float, Quantity("s/m", minimum=0)],
            default=0.0,
            doc="[s/m] by how much the force grows per speed of indentation, of itself; a pair "
            "takes the larger",
            mix=larger,
            needs="hertz_stiffness",
        ),
    ),
    fields=Fields(
        pair=[("hertz_stiffness", "f8"), ("hunt_crossley_dissipation", "f8")],
        contact=[
            ("hertz_stiffness", "f8"),  # k; 0: another law [N/m^1.5]
            ("dissipation", "f8"),  # a [s/m]
        ],
    ),
    hooks=Hooks(capture=make),
)
