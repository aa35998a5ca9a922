"""De Saxce's shifts of all contacts together, where a round's error is theirs.

A round leaves the defects d = mu |v_t| - s of its shifts s, as a function of all of them: what one
contact's shift changes, lifts and slows its neighbours, too. Their fixed point d = 0 is reached by
a constant factor a round, which may be 0.9 and more where what slides is heavy to turn and light
to tip; a secant of each contact by itself (`response.update_shift`) does not see it. Of the last
rounds the changes dS of the shifts and dD of the defects give the least squares

    min |d - dD g|,    s <- s + d - (dS + dD) g

which is Anderson's acceleration (D. G. Anderson, 1965). Columns are made orthogonal from the newest
to the oldest; one that adds no direction is left out.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from ...block import make_slip_velocity
from ...compile import kernel
from ...row_terms import row_terms
from ...spec import Spec
from .envelope import DEPTH

# A column with less than this share left beside the newer ones adds no direction [-].
NEW = 1e-6
# Rounds that stall before the shifts are brought on together.
PATIENCE = 2


def make_shift_together(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, workspace, kept) -> kept`: new shifts.

    kept: columns of the rounds before. None without friction.
    """
    if not row_terms(spec).frictional:
        return None
    slip_velocity, frictionless = make_slip_velocity(spec), row_terms(spec).frictionless

    def push_column(contacts, count, velocities, workspace, kept):
        by, led_to = workspace.shifted, workspace.defects
        for k in range(min(kept, DEPTH - 1), 0, -1):
            for c in range(count):
                by[k, c], led_to[k, c] = by[k - 1, c], led_to[k - 1, c]
        for c in range(count):
            contact = contacts[c]
            frictional = True
            if frictionless:
                frictional = contact.frictional == 1
            defect = 0.0
            if frictional:
                _, v_1, v_2 = slip_velocity(contact, velocities[contact.a], velocities[contact.b])
                defect = contact.mu * sqrt(v_1 * v_1 + v_2 * v_2) - contact.shift
            else:
                contact.shift, contact.shift_change, contact.defect = 0.0, 0.0, 0.0
            by[0, c], led_to[0, c] = contact.shift_change, defect - contact.defect
            contact.defect = defect
        return min(kept + 1, DEPTH)

    push_column = kernel(push_column, spec)

    def orthogonalise(workspace, count, kept):
        # Columns of dS take part in what is done to those of dD.
        shifts, defects = workspace.shift_basis, workspace.defect_basis
        for k in range(kept):
            before, after = 0.0, 0.0
            for c in range(count):
                shifts[k, c], defects[k, c] = workspace.shifted[k, c], workspace.defects[k, c]
                before += defects[k, c] * defects[k, c]
            for j in range(k):
                along, size = 0.0, 0.0
                for c in range(count):
                    along += defects[j, c] * defects[k, c]
                    size += defects[j, c] * defects[j, c]
                if size > 0.0:
                    share = along / size
                    for c in range(count):
                        defects[k, c] -= share * defects[j, c]
                        shifts[k, c] -= share * shifts[j, c]
            for c in range(count):
                after += defects[k, c] * defects[k, c]
            if not after > NEW * NEW * before:
                for c in range(count):
                    defects[k, c], shifts[k, c] = 0.0, 0.0

    orthogonalise = kernel(orthogonalise, spec)

    def shift_together(contacts, count, velocities, workspace, kept):
        kept = push_column(contacts, count, velocities, workspace, kept)
        orthogonalise(workspace, count, kept)
        shifts, defects = workspace.shift_basis, workspace.defect_basis
        for c in range(count):
            contacts[c].shift_change = contacts[c].defect
        for k in range(kept):
            along, size = 0.0, 0.0
            for c in range(count):
                along += defects[k, c] * contacts[c].defect
                size += defects[k, c] * defects[k, c]
            if size > 0.0:
                share = along / size
                for c in range(count):
                    contacts[c].shift_change -= share * (shifts[k, c] + defects[k, c])
        for c in range(count):
            contact = contacts[c]
            old = contact.shift
            contact.shift = max(old + contact.shift_change, 0.0)
            contact.shift_change = contact.shift - old
        return kept

    return kernel(shift_together, spec)
