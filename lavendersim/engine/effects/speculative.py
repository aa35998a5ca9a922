"""Speculative contacts: rows made before bodies touch require that a gap does not close too far.

    v_n >= -(phi - slop)/dt   for phi > slop
A body never falls into the floor before the floor reacts, and a fast one does not pass through it:
how far ahead a pair looks follows from the speeds of its bodies (`collide.narrow_phase`). Surfaces
within the slop of each other rest where they are: closing gaps of round-off size would keep every
stack moving.
"""

from ..step_terms import step_terms
from ..terms import StepTerms
from .decision import Decision, Facts, meeting
from .effect import Choice, Effect, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and something can touch."""
    if facts.speculative and meeting(facts):
        return Decision(True, "speculative is true")
    return Decision(False, "nothing can touch" if facts.speculative else "speculative is false")


def make(spec):
    """Return `kernel(contact, pair, params)`."""
    from ..free_flight import target_of_flight

    # Without either, a body moves through the whole step with the velocity it ends it with.
    flies = step_terms(spec).mean_flight or step_terms(spec).timed_impacts
    share = 0.5 if step_terms(spec).mean_flight else 0.0

    def speculative(contact, pair, params):
        if contact.phi > params.slop:
            contact.target += (contact.phi - params.slop) / params.dt
            if flies:
                # In free flight the gap closes by the mean velocity; where that leaves a gap, the
                # row must not brake what does not touch.
                closed = (contact.v_n_pre - share * contact.dv_n) * params.dt
                if contact.phi + closed > -params.slop:
                    contact.target = max(contact.target, target_of_flight(contact.v_n_pre))

    return kernel(speculative, spec)


EFFECT = Effect(
    name="speculative",
    decide=decide,
    per="contact",
    chosen_by=Choice("speculative"),
    step=StepTerms(ahead=True),
    hooks=Hooks(capture=make),
)
