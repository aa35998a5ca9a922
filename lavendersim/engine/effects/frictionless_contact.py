"""Frictionless contact: pairs without friction have rows of a normal alone, beside frictional ones.

Each contact is what its pair of surfaces requires. Where both kinds occur, `frictional` tells them
apart; a frictionless one then costs, and gives, what it would in a scene without friction, to the
bit.
"""

from typing import Any

from ..records import Field
from ..spec import Spec
from .decision import Decision, Facts, PairFacts, named
from .effect import Effect, Fields, kernel


def is_frictionless(pair: PairFacts) -> bool:
    """Whether contacts of the pair push along their normal alone."""
    return pair.surface.friction == 0.0 and not pair.resists_turning


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has no friction of any kind."""
    frictionless = [f"{pair.a} and {pair.b}" for pair in facts.pairs if is_frictionless(pair)]
    if frictionless:
        return Decision(True, f"{named(frictionless)}: coefficient 0")
    return Decision(
        False, "every pair that may touch has friction" if facts.pairs else "nothing can touch"
    )


def contact_fields(spec: Spec) -> list[Field]:
    """Return the column that tells the two kinds of contacts apart, where there are both."""
    return [("frictional", "i8")] if spec.has("friction") else []


def has_frictionless(spec: Spec) -> bool:
    """Whether an engine has contacts of a normal alone."""
    return spec.has("frictionless_contact") or not spec.has("friction")


def by_friction(spec: Spec, make_frictionless: Any, make_frictional: Any) -> Any:
    """Return the kernel for the contacts that an engine has: of one kind, or by the contact.

    make_frictionless, make_frictional: (spec) -> kernel(contact, ...), with equal arguments.
    """
    if not spec.has("friction"):
        return make_frictionless(spec)
    frictional = make_frictional(spec)
    if not spec.has("frictionless_contact"):
        return frictional
    frictionless = make_frictionless(spec)

    def either(contact, *others):
        if contact.frictional == 0:
            return frictionless(contact, *others)
        return frictional(contact, *others)

    either.__name__ = f"either_{frictionless.__name__}"  # as `lavender plan` lists them
    either.__qualname__ += f"_{frictionless.__name__}"
    return kernel(either, spec)


EFFECT = Effect(
    name="frictionless_contact",
    decide=decide,
    per="contact",
    fields=Fields(
        contact_with=contact_fields,
    ),
)
