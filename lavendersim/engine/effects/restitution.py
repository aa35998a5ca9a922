"""Restitution: the row asks v_n >= -e v_n_pre, captured once from the velocity before the solve.

Gravity alone gives a resting body the approach speed g dt in every step; restitution applies above
`restitution_speed` only, or resting contact would bounce for ever.
"""

from ..compile import kernel
from .decision import Decision, Facts

NAME = "restitution"
STAGE = "capture"
PAIR_FIELDS = [("restitution", "f8")]  # e of the pair, the larger of its surfaces' [-]


def wanted(facts: Facts) -> Decision:
    """On when a pair that may touch has a positive coefficient."""
    for pair in facts.pairs:
        if pair.restitution > 0.0:
            return Decision(True, f"{pair.a} and {pair.b}: coefficient {pair.restitution:g}")
    return Decision(False, "every pair that may touch has coefficient 0")


def make(spec):
    """Return `kernel(contact, pair, params)`."""

    def restitution(contact, pair, params):
        if -contact.v_n_pre > params.restitution_speed:
            contact.target += pair.restitution * contact.v_n_pre

    return kernel(restitution, spec)
