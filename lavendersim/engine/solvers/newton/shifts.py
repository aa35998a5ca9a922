"""De Saxce's shifts of all contacts together, where a round's error is theirs.

A round leaves the defects d = mu |v_t| - s of its shifts s, as a function of all of them: what one
contact's shift changes, lifts and slows its neighbours, too. Their fixed point d = 0 is reached by
a constant factor a round, which may be 0.9 and more where what slides is heavy to turn and light
to tip; a secant of each contact by itself (`response.update_shift`) does not see it. Anderson's
acceleration does (`anderson`).
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from ...anderson import make_bring_on
from ...block import make_slip_velocity
from ...compile import kernel
from ...row_terms import row_terms
from ...spec import Spec

# Rounds that stall before the shifts are brought on together.
PATIENCE = 2


def make_shift_together(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, rounds, columns) -> columns`: new shifts.

    rounds: their fixed point; columns: of the rounds before, `anderson.NO_ROUND` at first. None
    without friction.
    """
    if not row_terms(spec).frictional:
        return None
    slip_velocity, frictionless = make_slip_velocity(spec), row_terms(spec).frictionless
    bring_on = make_bring_on(spec)

    def shift_together(contacts, count, velocities, rounds, columns):
        for c in range(count):
            contact = contacts[c]
            frictional = True
            if frictionless:
                frictional = contact.frictional == 1
            rounds.point[c], rounds.defect[c] = 0.0, 0.0
            if frictional:
                _, v_1, v_2 = slip_velocity(contact, velocities[contact.a], velocities[contact.b])
                rounds.point[c] = contact.shift
                rounds.defect[c] = contact.mu * sqrt(v_1 * v_1 + v_2 * v_2) - contact.shift
        columns = bring_on(rounds, count, columns)
        for c in range(count):
            contact = contacts[c]
            old = contact.shift
            contact.shift = max(rounds.point[c], 0.0)
            contact.shift_change, contact.defect = contact.shift - old, rounds.last_defect[c]
        return columns

    return kernel(shift_together, spec)
