"""Restitution: Newton's law v_n >= -e v_n_pre, captured once from the velocity before the solve.

Captured at the start of the step: gravity alone gives a resting body the approach speed g dt in
every step, so the law applies above `restitution_speed` only, or resting contact would bounce for
ever. At the surface, `impact_time` applies the law itself and only takes the coefficient from here,
and so does the mistake of `capture_in_sweeps`.
"""

from ..step_terms import step_terms
from ..terms import StepTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Effect, Fields, Hooks, kernel
from .keys import SHARE, SurfaceKey, larger


def _described(pair: PairFacts[str]) -> str:
    e = pair.surface.restitution
    return f"coefficient {e:g}" if e > 0.0 else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch has a positive coefficient."""
    if any(pair.surface.restitution > 0.0 for pair in facts.pairs):
        return Decision(True, f"{by_pair(facts.pairs, _described)}; Newton's law")
    return Decision(False, "every pair that may touch has coefficient 0")


def make(spec):
    """Return `kernel(contact, pair, params)`."""
    from . import has_hook, made_once

    falls, restitution_at = made_once(spec, "restitution_at")

    def captured(contact, pair, params):
        if -contact.v_n_pre > params.restitution_speed:
            e = pair.restitution
            if falls:
                e = restitution_at(e, pair, -contact.v_n_pre)
                contact.e_impact = e
            contact.target += e * contact.v_n_pre

    def noted(contact, pair, params):
        contact.e = pair.restitution

    elsewhere = step_terms(spec).timed_impacts or has_hook(spec, "recapture")
    return kernel(noted if elsewhere else captured, spec)


EFFECT = Effect(
    name="restitution",
    decide=decide,
    per="contact",
    surface_keys=(
        SurfaceKey(
            name="restitution",
            type=SHARE,
            default=0.0,
            doc="share of the approach speed given back, 0 to 1; a pair takes the larger",
            mix=larger,
        ),
    ),
    step=StepTerms(rebounds=True),
    fields=Fields(
        pair=[("restitution", "f8")],  # e of the pair, the larger of its surfaces' [-]
    ),
    hooks=Hooks(capture=make),
)
