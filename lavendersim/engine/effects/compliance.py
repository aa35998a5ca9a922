"""Compliance: gamma = c/dt^2 softens a row, so that a load N rests at a penetration of its own.

c is the sum over the two surfaces (in series) [m/N]; divided by dt^2, not dt: the row is in
velocities and its unknown an impulse, F = lambda/dt and d = c F.
"""

from ..terms import RowTerms, StepTerms
from .decision import Decision, Facts, PairFacts, by_pair
from .effect import Effect, Fields, Hooks, kernel
from .keys import COMPLIANCE, SurfaceKey, in_series


def _described(pair: PairFacts[str]) -> str:
    c = pair.surface.compliance
    if c > 0.0:
        return f"compliance {c:g} m/N"
    return "gives way by a law of its own" if pair.is_soft else ""


def decide(facts: Facts) -> Decision:
    """On when a pair that may touch is compliant."""
    if any(pair.is_soft for pair in facts.pairs):
        return Decision(True, by_pair(facts.pairs, _described))
    return Decision(False, "every pair that may touch has compliance 0")


def make(spec):
    """Return `kernel(contact, pair, params)`."""

    def compliance(contact, pair, params):
        contact.gamma += pair.compliance / (params.dt * params.dt)

    return kernel(compliance, spec)


EFFECT = Effect(
    name="compliance",
    decide=decide,
    per="contact",
    row=RowTerms(compliant=True),
    step=StepTerms(bounces_vary=True),
    surface_keys=(
        SurfaceKey(
            name="compliance",
            type=COMPLIANCE,
            default=0.0,
            doc="[m/N] indentation per force; the two surfaces of a contact add",
            mix=in_series,
        ),
    ),
    fields=Fields(
        pair=[("compliance", "f8")],  # c of the pair [m/N]
        contact=[("gamma", "f8")],  # [1/kg]
    ),
    hooks=Hooks(capture=make),
)
