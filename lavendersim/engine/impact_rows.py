"""Which rows take part in a part of a step (`effects.impact_order`): all others wait."""

from __future__ import annotations

from typing import Any

from .approach import FAR, MEETS, make_approach, make_gap_acceleration, make_slowest
from .compile import kernel
from .effects import made_once
from .overlooked_points import make_note_waiting
from .records import TOUCHING
from .row_terms import make_is_soft, row_terms
from .spec import Spec
from .step_terms import step_terms
from .stiff_springs import make_takes_time

# What two bodies that turn close of their last gaps in one instant, in slops. A face that comes
# down about an edge which lies a slop deep meets with the points next to that edge before others.
FLUSH = 10.0
# What moves by less than this share of the other's speed lies there and is shaken: as it meets it
# brings nothing along, as it parts it is pressed by what meets.
SHAKEN = 0.02


def _make_is_plastic(spec: Spec) -> Any:
    """Return `kernel(contact, pair) -> whether` it is of rigid surfaces that throw nothing back."""
    springs, ropes = row_terms(spec).elastic, row_terms(spec).taut
    bilateral, stopped = row_terms(spec).bilateral, row_terms(spec).stopped
    rebounds = step_terms(spec).rebounds
    is_soft: Any = make_is_soft(spec) if springs else None

    def is_plastic(contact, pair):
        plastic = True
        if rebounds:
            plastic = pair.restitution == 0.0
        if springs:
            plastic = plastic and not is_soft(pair)
        if ropes:
            plastic = plastic and contact.span == 0.0
        if bilateral:
            plastic = plastic and contact.bilateral == 0
        if stopped:
            plastic = plastic and contact.stop == 0
        return plastic

    return kernel(is_plastic, spec)


def make_meet_flush(spec: Spec) -> Any:
    """Return `kernel(state, count, first, params)`.

    What else of its two bodies meets in one instant with `first`, a row that meets, where nothing
    is thrown back. What is as good as flush counts as met. What lies there and parts by what going
    round bends of a step counts as neither meeting nor parting: the impact may press on it.
    """
    gap_acceleration, approach = make_gap_acceleration(spec), make_approach(spec)
    is_plastic = _make_is_plastic(spec)

    def meet_flush(state, count, first, params):
        contacts, pairs, bodies, motion = state.contacts, state.pairs, state.bodies, state.motion
        flush = FLUSH * params.slop
        for c in range(count):
            contact = contacts[c]
            if contact.a != first.a or contact.b != first.b or contact.phi > flush:
                continue
            if not is_plastic(contact, pairs[contact.pair]):
                continue
            if contact.located == FAR:  # too little is left of the step to get there
                contact.rate = approach(contact, bodies, motion)
            if contact.rate < 0.0 and contact.phi > TOUCHING:
                if first.rate < SHAKEN * contact.rate:
                    contact.phi = TOUCHING
            elif contact.rate > 0.0 and contact.phi <= params.slop:
                bent = gap_acceleration(contact, bodies, motion) * params.timestep
                if contact.rate <= min(bent, -SHAKEN * first.rate):
                    contact.rate = 0.0

    return kernel(meet_flush, spec)


def make_mark_impact(spec: Spec) -> Any:
    """Return `kernel(state, count, params) -> rows` of the impact.

    All others wait.
    """
    otherwise, mark = made_once(spec, "mark_impact")
    return mark if otherwise else _make_together(spec)


def _make_together(spec: Spec) -> Any:
    """Rows that touch a body of the impact, and do not part.

    An impact is handed on from body to body, as far as it goes.
    """
    slowest, springs = make_slowest(spec), row_terms(spec).elastic
    bilateral, turns = row_terms(spec).bilateral, step_terms(spec).turns
    meet_flush: Any = make_meet_flush(spec) if turns else None
    takes_time: Any = make_takes_time(spec) if springs else None

    def hands_on(contact, bodies, motion):
        # What does not move hands nothing on.
        by_a = motion[contact.a].in_impact == 1 and bodies[contact.a].inv_m > 0.0
        return by_a or (motion[contact.b].in_impact == 1 and bodies[contact.b].inv_m > 0.0)

    hands_on = kernel(hands_on, spec)

    def mark_impact(state, count, params):
        contacts, pairs, bodies, motion = state.contacts, state.pairs, state.bodies, state.motion
        slop = params.slop
        for i in range(motion.shape[0]):
            motion[i].in_impact = 0
        if turns:
            for c in range(count):
                if contacts[c].located == MEETS:
                    meet_flush(state, count, contacts[c], params)
        for c in range(count):
            contact = contacts[c]
            takes_part = contact.phi <= TOUCHING or (contact.phi <= slop and contact.waits == 0)
            if springs:
                takes_part = takes_part and not takes_time(
                    contact, pairs[contact.pair], bodies, params
                )
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
