"""Stabilisation: bias velocity b = -(beta/dt) max(d - slop, 0) that separates what penetrates."""

from .decision import Decision, Facts, meeting
from .effect import Effect, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the gain is positive."""
    gain = facts.stabilisation_gain
    if gain > 0.0 and meeting(facts):
        return Decision(True, f"stabilisation_gain is {gain:g}")
    return Decision(False, "stabilisation_gain is 0" if gain == 0.0 else "nothing can touch")


def make(spec):
    """Return `kernel(contact, pair, params)`."""

    def stabilisation(contact, pair, params):
        excess = -contact.phi - params.slop
        if excess > 0.0:
            contact.target -= params.stabilisation_gain / params.dt * excess

    return kernel(stabilisation, spec)


EFFECT = Effect(
    name="stabilisation",
    decide=decide,
    per="contact",
    hooks=Hooks(capture=make),
)
