"""Smooth contact: pairs without friction keep rows of a normal alone, beside blocks that rub.

Each contact is what its pair of surfaces requires. Where both kinds occur, `rough` tells them
apart; a smooth one then costs, and gives, what it would in a scene without friction, to the bit.
"""

from typing import Any

from ..records import Field
from ..spec import Spec
from .decision import Decision, Facts, PairFacts, named
from .effect import Effect, Fields, kernel


def is_smooth(pair: PairFacts) -> bool:
    """Whether contacts of the pair push along their normal alone."""
    return pair.surface.friction == 0.0 and not pair.resists_turning


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has no friction of any kind."""
    smooth = [f"{pair.a} and {pair.b}" for pair in facts.pairs if is_smooth(pair)]
    if smooth:
        return Decision(True, f"{named(smooth)}: coefficient 0")
    return Decision(False, "every pair that may touch rubs" if facts.pairs else "nothing can touch")


def contact_fields(spec: Spec) -> list[Field]:
    """Return the column that tells smooth contacts from rough ones, where there are both."""
    return [("rough", "i8")] if spec.has("friction") else []


def has_smooth(spec: Spec) -> bool:
    """Whether an engine has contacts of a normal alone."""
    return spec.has("smooth_contact") or not spec.has("friction")


def by_roughness(spec: Spec, make_smooth: Any, make_rough: Any) -> Any:
    """Return the kernel for the contacts that an engine has: smooth, rough, or by the contact.

    make_smooth, make_rough: (spec) -> kernel(contact, ...), alike in arguments and results.
    """
    if not spec.has("friction"):
        return make_smooth(spec)
    rough = make_rough(spec)
    if not spec.has("smooth_contact"):
        return rough
    smooth = make_smooth(spec)

    def either(contact, *others):
        if contact.rough == 0:
            return smooth(contact, *others)
        return rough(contact, *others)

    either.__name__ = f"either_{smooth.__name__}"  # each has a symbol of its own
    either.__qualname__ += f"_{smooth.__name__}"
    return kernel(either, spec)


EFFECT = Effect(
    name="smooth_contact",
    decide=decide,
    per="contact",
    fields=Fields(
        contact_with=contact_fields,
    ),
)
