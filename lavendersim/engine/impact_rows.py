"""Which rows take part in a part of a step (`effects.impact_order`): all others wait."""

from __future__ import annotations

from typing import Any

from .approach import MEETS, make_slowest
from .compile import kernel
from .records import TOUCHING
from .spec import Spec

# Approaches that differ by less than this share are equally fast: round-off parts no symmetry.
EQUAL = 1e-9


def make_mark_impact(spec: Spec) -> Any:
    """Return `kernel(contacts, count, pairs, bodies, motion, slop) -> rows` of the impact.

    All others wait.
    """
    return _make_pairwise(spec) if spec.has("pairwise_impacts") else _make_together(spec)


def _make_pairwise(spec: Spec) -> Any:
    """Rows between the two bodies that approach fastest, of those that meet."""
    slowest, springs = make_slowest(spec), spec.has("contact_spring")

    def mark_pairs(contacts, count, pairs, bodies, motion, slop):
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
            for d in range(count):
                contact = contacts[d]
                if contact.a != first.a or contact.b != first.b or contact.waits == 0:
                    continue
                takes_part = contact.phi <= max(TOUCHING, slop)
                if springs:
                    takes_part = takes_part and pairs[contact.pair].compliance == 0.0
                if takes_part and contact.rate <= slowest(contact, bodies, motion):
                    contact.waits = 0
                    rows += 1
        return rows

    return kernel(mark_pairs, spec)


def _make_together(spec: Spec) -> Any:
    """Rows that touch a body of the impact, and do not part.

    An impact is handed on from body to body, as far as it goes.
    """
    slowest, springs = make_slowest(spec), spec.has("contact_spring")

    def hands_on(contact, bodies, motion):
        # What does not move hands nothing on.
        by_a = motion[contact.a].in_impact == 1 and bodies[contact.a].inv_m > 0.0
        return by_a or (motion[contact.b].in_impact == 1 and bodies[contact.b].inv_m > 0.0)

    hands_on = kernel(hands_on, spec)

    def mark_impact(contacts, count, pairs, bodies, motion, slop):
        for i in range(motion.shape[0]):
            motion[i].in_impact = 0
        for c in range(count):
            contact = contacts[c]
            takes_part = contact.phi <= TOUCHING or (contact.phi <= slop and contact.waits == 0)
            if springs:
                takes_part = takes_part and pairs[contact.pair].compliance == 0.0
            if takes_part:
                takes_part = contact.rate <= slowest(contact, bodies, motion)
            contact.waits = 0 if takes_part else 1
            if contact.located == MEETS:
                motion[contact.a].in_impact = 1
                motion[contact.b].in_impact = 1
        spreads, rows = True, 0
        while spreads:
            spreads, rows = False, 0
            for c in range(count):
                contact = contacts[c]
                if contact.waits == 0 and hands_on(contact, bodies, motion):
                    rows += 1
                    a, b = motion[contact.a], motion[contact.b]
                    spreads = spreads or a.in_impact == 0 or b.in_impact == 0
                    a.in_impact, b.in_impact = 1, 1
        for c in range(count):
            if not hands_on(contacts[c], bodies, motion):
                contacts[c].waits = 1
        return rows

    return kernel(mark_impact, spec)


def make_keep_present(spec: Spec) -> Any:
    """Return `kernel(contacts, count) -> count`: without those that wait."""

    def keep_present(contacts, count):
        kept = 0
        for c in range(count):
            if contacts[c].waits == 0:
                if kept < c:
                    contacts[kept] = contacts[c]
                kept += 1
        return kept

    return kernel(keep_present, spec)
