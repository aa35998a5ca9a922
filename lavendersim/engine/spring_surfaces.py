"""Unions whose surfaces do work on them or store energy: what they have then tells nothing.

A union (`spring_unions`) is such where what pushes or ties it is kinematic and moves, a surface
that pushes it moves along itself, its contact gives way by the regularised law, or a motor drives
it. What surfaces elsewhere do changes nothing of it. What a `contact_spring` stores is known.
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .contact import make_normal_velocity
from .contact_spring_law import make_stored
from .effects import has_hook
from .row_terms import make_acts, row_terms
from .spec import Spec
from .step_terms import step_terms


def make_note_working(spec: Spec) -> Any:
    """Return `kernel(state, rows, count) -> whether any is such`; noted at the first body of each.

    rows: bodies where the step begins, joined.
    """
    kinematic = step_terms(spec).kinematic
    compliance, springs = row_terms(spec).compliant, row_terms(spec).elastic
    moving, turns = has_hook(spec, "surface_velocity"), step_terms(spec).turns
    acts, bounded = make_acts(spec), row_terms(spec).bounded

    def moves(body, v):
        found = False
        if kinematic:
            if body.kinematic == 1:
                found = v.vx != 0.0 or v.vy != 0.0 or v.vz != 0.0
                if turns:
                    found = found or v.wx != 0.0 or v.wy != 0.0 or v.wz != 0.0
        return found

    moves = kernel(moves, spec)

    def slides(body):
        found = False
        if moving:
            found = body.sx != 0.0 or body.sy != 0.0 or body.sz != 0.0
        return found

    slides = kernel(slides, spec)

    def note_working(state, rows, count):
        links, contacts, velocities = state.links, state.contacts, state.velocities
        any_works = False
        for i in range(rows.shape[0]):
            rows[i].worked = 0
        for k in range(links.shape[0]):
            a, b = rows[links[k].a], rows[links[k].b]
            if links[k].again == 1:
                if moves(a, velocities[links[k].a]) or moves(b, velocities[links[k].b]):
                    rows[max(a.group, b.group) - 1].worked, any_works = 1, True
        for c in range(count):
            contact = contacts[c]
            a, b = rows[contact.a], rows[contact.b]
            group = max(a.group, b.group)
            if group > 0 and acts(contact):
                works = moves(a, velocities[contact.a]) or moves(b, velocities[contact.b])
                works = works or slides(a) or slides(b)
                if bounded:
                    works = works or contact.motor == 1
                if compliance:
                    gives_way = state.pairs[contact.pair].compliance > 0.0
                    if springs:
                        gives_way = False
                    works = works or gives_way
                if works and rows[group - 1].again == 1:
                    rows[group - 1].worked, any_works = 1, True
        return any_works

    return kernel(note_working, spec)


def make_stored_in_contacts(spec: Spec) -> Any:
    """Return `kernel(contacts, count, rows, shifts) -> (won, had)`: by contact springs [J].

    Of unions that nothing works on. shifts: displacements [m, rad].
    """
    normal_shift, stored = make_normal_velocity(spec), make_stored(spec)

    def stored_in_contacts(contacts, count, rows, shifts):
        won, had = 0.0, 0.0
        for c in range(count):
            contact = contacts[c]
            group = max(rows[contact.a].group, rows[contact.b].group)
            if group == 0 or contact.spring_compliance == 0.0 or contact.lambda_n <= 0.0:
                continue
            if rows[group - 1].again == 1 and rows[group - 1].worked == 0:
                begin = contact.phi
                end = begin + normal_shift(contact, shifts[contact.a], shifts[contact.b])
                before, after = stored(contact, -begin), stored(contact, -end)
                won, had = won + (after - before), had + min(before, after)
        return won, had

    return kernel(stored_in_contacts, spec)
