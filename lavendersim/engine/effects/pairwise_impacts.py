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

from typing import Any

from ..records import TOUCHING
from ..spec import Spec
from ..step_terms import step_terms
from .decision import Decision, Facts
from .effect import Choice, Effect, Hooks, kernel

# Approaches that differ by less than this share are equally fast: round-off parts no symmetry.
EQUAL = 1e-9


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and several bodies may meet at once."""
    if facts.simultaneous_impacts != "pairwise":
        return Decision(False, f"simultaneous_impacts are solved {facts.simultaneous_impacts}")
    if facts.impacts != "in_order" or facts.pair_count < 2:
        return Decision(False, "no two pairs of bodies can meet at once")
    return Decision(True, "simultaneous_impacts are pairwise")


def make_mark_impact(spec: Spec) -> Any:
    """Return `kernel(state, count, params) -> rows` of the impact.

    They are those between the two bodies that approach fastest, of all that meet.
    """
    from ..approach import MEETS, make_slowest
    from ..impact_rows import make_meet_flush
    from ..row_terms import row_terms
    from ..stiff_springs import make_takes_time

    slowest, springs = make_slowest(spec), row_terms(spec).elastic
    turns = step_terms(spec).turns
    meet_flush: Any = make_meet_flush(spec) if turns else None
    takes_time: Any = make_takes_time(spec) if springs else None

    def mark_pairs(state, count, params):
        contacts, pairs, bodies, motion = state.contacts, state.pairs, state.bodies, state.motion
        fastest = 0.0
        for c in range(count):
            if contacts[c].located == MEETS:
                fastest = min(fastest, contacts[c].rate)
        for c in range(count):
            contacts[c].waits = 1
        rows = 0
        for c in range(count):
            first = contacts[c]
            if first.located != MEETS or first.rate > fastest * (1.0 - EQUAL):
                continue
            if turns:
                meet_flush(state, count, first, params)
            for d in range(count):
                contact = contacts[d]
                if contact.a != first.a or contact.b != first.b or contact.waits == 0:
                    continue
                takes_part = contact.phi <= max(TOUCHING, params.slop)
                if springs:
                    pair = pairs[contact.pair]
                    takes_part = takes_part and not takes_time(contact, pair, bodies, params)
                if takes_part and contact.rate <= slowest(contact, bodies, motion):
                    contact.waits = 0
                    rows += 1
        return rows

    return kernel(mark_pairs, spec)


EFFECT = Effect(
    name="pairwise_impacts",
    decide=decide,
    per="contact",
    needs=("impact_order",),
    chosen_by=Choice("simultaneous_impacts"),
    hooks=Hooks(mark_impact=make_mark_impact),
)
