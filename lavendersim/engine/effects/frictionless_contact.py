"""Frictionless contact: pairs without friction have rows of a normal alone, beside frictional ones.

Each contact is what its pair of surfaces requires. Where both kinds occur, `frictional` tells them
apart; a frictionless one then costs, and gives, what it would in a scene without friction, to the
bit.
"""

from ..records import Field
from ..spec import Spec
from ..terms import RowTerms
from .decision import Decision, Facts, PairFacts, named
from .effect import Effect, Fields


def is_frictionless(pair: PairFacts[str]) -> bool:
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
    from ..row_terms import row_terms

    return [("frictional", "i8")] if row_terms(spec).frictional else []


EFFECT = Effect(
    name="frictionless_contact",
    decide=decide,
    per="contact",
    row=RowTerms(frictionless=True),
    fields=Fields(
        contact_with=contact_fields,
    ),
)
