"""Midpoint: a body in free flight moves with the mean of its old and new velocity.

    x += dt (v_old + v_new)/2,   exact under a constant acceleration
A body that a contact holds moves with its new velocity, which is the one that respects the contact.
"""

from ..terms import StepTerms
from .decision import Decision, Facts
from .effect import Choice, Effect, Fields


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and something accelerates bodies between contacts."""
    if facts.integrator == "semi_implicit_euler":
        return Decision(False, f"the integrator is {facts.integrator}")
    from . import EFFECTS  # by the time it is asked, all are there

    for effect in EFFECTS:
        hooks = effect.hooks
        accelerates = hooks.accelerate or hooks.act_between or hooks.preload
        if accelerates and effect.decide(facts).on:
            name = effect.name.replace("_", " ")
            return Decision(True, f"integrator is midpoint and {name} accelerates bodies")
    return Decision(False, "free bodies keep their velocity, any integrator moves them alike")


EFFECT = Effect(
    name="midpoint",
    decide=decide,
    per="body",
    chosen_by=Choice("integrator"),
    step=StepTerms(mean_flight=True),
    fields=Fields(
        contact=[("dv_n", "f8")],  # change of v_n by forces in this step [m/s]
    ),
)
