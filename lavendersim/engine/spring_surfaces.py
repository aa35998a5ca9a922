"""Unions whose surfaces do work on them or store energy: what they have then tells nothing.

A union (`spring_unions`) is such where what pushes or ties it is kinematic, a surface that pushes it
moves along itself, or its contact gives way. What surfaces elsewhere do changes nothing of it.
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .spec import Spec


def make_note_working(spec: Spec) -> Any:
    """Return `kernel(state, rows, count) -> whether any is such`; noted at the first body of each.

    rows: bodies where the step begins, joined.
    """
    kinematic, gives_way = spec.has("kinematic"), spec.has("compliance")
    moving, turns = spec.has("surface_velocity"), spec.has("rotation")

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
            if contact.lambda_n > 0.0 and group > 0:
                works = moves(a, velocities[contact.a]) or moves(b, velocities[contact.b])
                works = works or slides(a) or slides(b)
                if gives_way:
                    works = works or state.pairs[contact.pair].compliance > 0.0
                if works and rows[group - 1].again == 1:
                    rows[group - 1].worked, any_works = 1, True
        return any_works

    return kernel(note_working, spec)
