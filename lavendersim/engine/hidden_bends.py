"""Bends of contact forces that the difference of a whole substep and its halves does not show.

A contact that comes to push no more, under forces that change in time, has a force that bends to 0.
A part of a step has the mean of what presses and of what pulls, and what leaves is slower than it
should be. Where that is early in a substep of h, or late, the whole and the halves miss it alike.
Of a jump j of the rate of the acceleration, at t:
    t < h/4        j t^2/2, at most j (h/4)^2/2; the second half gains j h^2/4 more than the first
    t > h/4        j (h - t)^2/2 less what the halves gain; forces in the halves tell j and t
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, length

# Of what halves of a substep gain more or less than each other, j h^2/4: j (h/4)^2/2.
HIDDEN = 0.125
# Rates of a force that bends are alike within this factor, from one half to the next [-].
LIKE = 4.0
# A bend is looked for in substeps that are longer than this share of a step: its missed part is
# 1/65,000 of what it is in a whole one, and what was taken for one by mistake ends no run.
BENDS = 1.0 / 256.0


def make_note_loads(spec: Spec) -> Any:
    """Return `kernel(contacts, count, paths, dt)`: with what force contacts push bodies [N].

    Of the part that ends, of dt; joints do not count, nor what gives way: its force has no bend.
    """
    terms = row_terms(spec)
    bilateral, compliant = terms.bilateral, terms.compliant

    def note_loads(contacts, count, paths, dt):
        for i in range(paths.shape[0]):
            paths[i].first_load, paths[i].last_load = paths[i].last_load, 0.0
        for c in range(count):
            contact = contacts[c]
            pushes = contact.lambda_n > 0.0
            if bilateral:
                pushes = pushes and contact.bilateral == 0
            if compliant:
                pushes = pushes and contact.gamma == 0.0
            if pushes:
                paths[contact.a].last_load += contact.lambda_n / dt
                paths[contact.b].last_load += contact.lambda_n / dt

    return kernel(note_loads, spec)


def make_missed(spec: Spec) -> Any:
    """Return `kernel(body, before, middle, after, path, half) -> speed` that is missed [m/s].

    before, middle, after: velocities as a substep begins and where its halves end; half: of it [s].
    Forces that jump are no bends: neither what ends at once nor what an impact leaves.
    """
    turns = step_terms(spec).turns

    def missed(body, before, middle, after, path, half):
        between = 0.5 * (path.load_dt + half)
        if path.last_load == 0.0:  # it has left
            x = after.vx - 2.0 * middle.vx + before.vx
            y = after.vy - 2.0 * middle.vy + before.vy
            z = after.vz - 2.0 * middle.vz + before.vz
            more = length(Vec3(x, y, z))
            if turns:
                x = after.wx - 2.0 * middle.wx + before.wx
                y = after.wy - 2.0 * middle.wy + before.wy
                z = after.wz - 2.0 * middle.wz + before.wz
                more += body.bound * length(Vec3(x, y, z))
            if path.first_load == 0.0:  # in the first half
                gained = body.inv_m * path.load * half * half
                return HIDDEN * more if gained <= LIKE * more * (between + half) else 0.0
            rate = (path.load - path.first_load) / between
            since = 1.5 * half - path.first_load / rate if rate > 0.0 else 0.0
            return abs(0.5 * body.inv_m * rate * since * since - more) if since > 0.0 else 0.0
        pulls = 0.5 * path.first_load - 1.5 * path.last_load
        falls = path.first_load - path.last_load
        if pulls > 0.0 and LIKE * (path.load - path.first_load) * half >= falls * between:
            return 0.5 * half * body.inv_m * pulls * pulls / falls  # it is about to
        return 0.0

    return kernel(missed, spec)
