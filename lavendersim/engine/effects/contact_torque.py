"""Contact torque: rows get levers r x n, and their effective mass its rotational part."""

from ..records import LEVER
from ..terms import RowTerms
from .decision import Decision, Facts, named
from .effect import Effect, Fields


def decide(facts: Facts) -> Decision:
    """On when a contact may push a movable body past its centre of mass."""
    if not facts.pairs:
        return Decision(False, "nothing can touch")
    levered = [
        body.name
        for body in facts.bodies
        if body.shape != "sphere" and (body.movable or (body.kinematic and body.spins))
    ]
    if levered:
        return Decision(True, f"{named(levered)}: contact normals may miss the centre of mass")
    for pair in facts.pairs:
        if pair.off_centre:
            return Decision(
                True, f"{pair.a} and {pair.b}: a {pair.shape_pair} pulls off the centre of mass"
            )
        if pair.surface.friction > 0.0:
            return Decision(True, f"{pair.a} and {pair.b}: friction acts off the centre of mass")
        if pair.resists_turning:
            return Decision(True, f"{pair.a} and {pair.b}: their contact resists turning")
    return Decision(False, "every contact normal passes through the centre of mass it pushes")


def contact_fields(spec):
    """Return the columns of a normal row; the blocks of friction have levers of their own."""
    from ..row_terms import row_terms

    return LEVER if row_terms(spec).frictionless else []


EFFECT = Effect(
    name="contact_torque",
    decide=decide,
    per="contact",
    row=RowTerms(levers=True),
    needs=("rotation",),
    fields=Fields(
        contact_with=contact_fields,
    ),
)
