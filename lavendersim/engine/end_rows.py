"""Rows of joints where a substep ends, for its error estimate (`error_estimate`).

At the end of a step the ends of a joint part by O(dt^2), because its rows hold at the middle; the
next step turns that round, p to -p. So a whole substep ends with -p, and its halves with p again:
2 p of their difference says nothing of what is to come. All of it is along rows at the end, and of
rows at the middle a share in proportion to dt is not. That would be taken for an error, and as what
a substep may be off by falls with dt as well, none would be short enough.
"""

from __future__ import annotations

from typing import Any

from .collide.joint import direction, put_ends
from .collide.records import put_normal
from .compile import kernel
from .contact import make_complete_row
from .effects import made_once
from .row_terms import row_terms
from .spec import Spec


def make_stand_at_end(spec: Spec) -> Any:
    """Return `kernel(state, count, velocities)`: rows of joints as their bodies stand.

    velocities: what rows of contacts with friction turn, by the inertia that these have.
    """
    bounded, levers = row_terms(spec).bounded, row_terms(spec).levers
    complete_row = make_complete_row(spec)
    _, place_parts = made_once(spec, "place_parts")
    carries_inertia, refresh_inertia = made_once(spec, "refresh_inertia")

    def stand_at_end(state, count, velocities):
        bodies = state.bodies
        place_parts(bodies)
        if carries_inertia:
            refresh_inertia(bodies, velocities)
        for c in range(count):
            contact = state.contacts[c]
            if contact.bilateral == 1:
                pair = state.pairs[contact.pair]
                end_a, end_b = bodies[pair.a], bodies[pair.b]
                a, b = bodies[contact.a], bodies[contact.b]
                turns = False
                if bounded:
                    turns = contact.couple == 1
                if not turns:
                    put_normal(contact, direction(pair.kind, end_a))
                if levers:
                    put_ends(contact, pair.kind, end_a, end_b, a, b)
                contact.k_n = complete_row(contact, a, b)

    return kernel(stand_at_end, spec)
