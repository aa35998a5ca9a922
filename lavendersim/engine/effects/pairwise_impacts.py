"""Pairwise impacts: of what meets in one instant two bodies at a time, the fastest first.

Impacts of one instant are one problem by default: every contact that touches has its row, and all
of them Newton's law at once. Pair by pair the two bodies that approach fastest collide alone, then
those that do so after it, until nothing approaches: the limit of small gaps, in which a row of
touching balls hands a blow on. Pairs that approach equally fast collide together, so that what is
symmetric stays so.

A sequence of impacts with e < 1 ends where an approach is so slow that it is no impact
(`foreseen_impacts`); one that spends the step's work ends without order (`impact_order`).
"""

from __future__ import annotations

from .decision import Decision, Facts
from .effect import Choice, Effect


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and several bodies may meet at once."""
    if facts.simultaneous_impacts != "pairwise":
        return Decision(False, f"simultaneous_impacts are solved {facts.simultaneous_impacts}")
    if facts.impacts != "in_order" or facts.pair_count < 2:
        return Decision(False, "no two pairs of bodies can meet at once")
    return Decision(True, "simultaneous_impacts are pairwise")


EFFECT = Effect(
    name="pairwise_impacts",
    decide=decide,
    per="contact",
    needs=("impact_order",),
    chosen_by=Choice("simultaneous_impacts"),
)
