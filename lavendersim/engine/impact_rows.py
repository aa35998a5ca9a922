"""Which rows take part in a part of a step (`effects.impact_order`): all others wait."""

from __future__ import annotations

from typing import Any

from .approach import MEETS, make_slowest
from .compile import kernel
from .effects import made_once
from .overlooked_points import make_note_waiting
from .records import TOUCHING
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms


def make_mark_impact(spec: Spec) -> Any:
    """Return `kernel(contacts, count, pairs, bodies, motion, slop) -> rows` of the impact.

    All others wait.
    """
    otherwise, mark = made_once(spec, "mark_impact")
    return mark if otherwise else _make_together(spec)


def _make_together(spec: Spec) -> Any:
    """Rows that touch a body of the impact, and do not part.

    An impact is handed on from body to body, as far as it goes.
    """
    slowest, springs = make_slowest(spec), row_terms(spec).elastic
    bilateral = row_terms(spec).bilateral

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
            if bilateral:
                takes_part = takes_part or contact.bilateral == 1
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


def make_keep_motion(spec: Spec) -> Any:
    """Return `kernel(contacts, count, overlooked) -> count`: the same of a part that is motion.

    Those that wait are noted, since a push of the others may make them meet in it.
    """
    keep_present, overlooks = make_keep_present(spec), step_terms(spec).overlooks
    note_waiting: Any = make_note_waiting(spec) if overlooks else None

    def keep_motion(contacts, count, overlooked):
        if overlooks:
            for c in range(count):
                if contacts[c].waits == 1:
                    note_waiting(contacts[c], overlooked)
        return keep_present(contacts, count)

    return kernel(keep_motion, spec)
