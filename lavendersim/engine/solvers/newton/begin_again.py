"""What rounds of Newton's method leave begins again from inside the cones, and rounds follow.

Then sweeps take turns with rounds, each from where the other ended: many sweeps change who holds,
slides and opens where a round would not leave its own. That is for a few steps in thousands, and
the longest turns only where little is left.

Where every contact is a cone, whatever else an engine knows: a scene's bits are those of an engine
without. What is left is no worse than before.
"""

from __future__ import annotations

from math import inf
from typing import Any

from ...compile import kernel, separate
from ...identity import SELDOM
from ...residual import make_residual
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from ..sweep import make_sweep
from .alart_curnier import make_alart_curnier
from .factor import eliminates
from .inside_cones import LONG_STEPS, MOST, SHORT_STEPS, make_from_inside
from .kept_velocities import (
    LOST,
    OF_BEFORE,
    make_keep_velocities,
    make_put_velocities,
    make_speed,
)
from .method import make_set_impulse
from .rounds import STIFF_ENOUGH
from .torques import make_limits_torque

# Steps of the rounds that follow: from near their end they take a few.
FINISHING = 40.0
# Sweeps of the first turn where that leaves something, twice as many of each next one.
SWEEPS, TURNS = 1000, 6
# Turns at most where more is left than so many times what is enough.
FEWER_TURNS, NEAR = 4, 10.0
# Visits of a turn at most where bodies are many: what this solves is rare, and a large scene's
# turns would take minutes.
MOST_VISITS = 10_000_000
# Columns of `Envelope.inside` behind those of `inside_cones`, along n, t1 and t2: best impulses,
# and those that it began with [N s].
BEST, FIRST = 3, 6


def make_are_cones(spec: Spec) -> Any:
    """Return `kernel(contacts, count) -> whether` all are: rigid, one-sided, of no torque."""
    terms = row_terms(spec)
    bilateral, compliant, spins = terms.bilateral, terms.compliant, resists_turning(spec)
    limits_torque: Any = make_limits_torque(spec) if spins else None

    def are_cones(contacts, count):
        for c in range(count):
            contact, other = contacts[c], False
            if bilateral:
                other = contact.bilateral == 1
            if compliant:
                other = other or contact.gamma > 0.0
            if spins:
                other = other or limits_torque(contact)
            if other:
                return False
        return True

    return kernel(are_cones, spec)


def make_begin_again(spec: Spec) -> Any:
    """Return `kernel(system, workspace, size, most, residuals, params) -> steps`.

    As that of `make_alart_curnier`, whose rounds follow: from inside, they find who holds, slides
    and opens. None where a contact is no cone. The best impulses of all are left, those of before
    among them.
    """
    if not row_terms(spec).frictional:
        return None
    residual, from_inside = make_residual(spec), make_from_inside(spec)
    alart_curnier, set_impulse = make_alart_curnier(spec), make_set_impulse(spec)
    are_cones, sweep = make_are_cones(spec), make_sweep(spec)
    many = eliminates(spec)
    keep_velocities, put_velocities = make_keep_velocities(spec), make_put_velocities(spec)
    speed = make_speed(spec)

    def keep(contacts, count, workspace, at):
        for c in range(count):
            contact, kept = contacts[c], workspace.inside[c]
            kept[at] = contact.lambda_n
            kept[at + 1], kept[at + 2] = contact.lambda_1, contact.lambda_2

    keep = kernel(keep, spec)

    def put_first(contacts, count, workspace):
        for c in range(count):
            contact, kept = contacts[c], workspace.inside[c]
            contact.lambda_n = kept[FIRST]
            contact.lambda_1, contact.lambda_2 = kept[FIRST + 1], kept[FIRST + 2]

    put_first = kernel(put_first, spec)

    def end_with_rounds(system, workspace, size, most, residuals, least):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        most, before = min(most, FINISHING), speed(contacts, count, velocities)
        steps = alart_curnier(system, workspace, size, most, residuals, STIFF_ENOUGH)
        after, _ = residual(contacts, count, velocities)
        if after < least:
            keep(contacts, count, workspace, BEST)
            least = after
        return steps, least, max(before, speed(contacts, count, velocities))

    end_with_rounds = kernel(end_with_rounds, spec)

    def begin_again(system, workspace, size, most, residuals, params):
        tolerance, enough = residuals
        contacts, count, velocities = system.contacts, system.count, system.velocities
        least, _ = residual(contacts, count, velocities)
        if least <= enough or not are_cones(contacts, count):
            return 0
        keep(contacts, count, workspace, BEST)
        keep(contacts, count, workspace, FIRST)
        keep_velocities(velocities, workspace, size, OF_BEFORE)
        usual, peak, tried = speed(contacts, count, velocities), 0.0, 0.0
        made, steps = 0, 0
        for strategy in (LONG_STEPS, SHORT_STEPS):
            if not least <= enough:
                made += from_inside(
                    system, workspace, size, min(most, float(MOST)), strategy, tolerance
                )
                steps, least, tried = end_with_rounds(
                    system, workspace, size, most, residuals, least
                )
                made, peak = made + steps, max(peak, tried)
        for turn in range(TURNS):
            affordable = not many or (SWEEPS << turn) * count <= MOST_VISITS
            if (
                affordable
                and not least <= enough
                and (turn < FEWER_TURNS or least <= NEAR * enough)
            ):
                for _ in range(SWEEPS << turn):
                    sweep(system, params)
                steps, least, tried = end_with_rounds(
                    system, workspace, size, most, residuals, least
                )
                made, peak = made + steps, max(peak, tried)
        left, _ = residual(contacts, count, velocities)
        if peak > LOST * usual or not left < inf:
            put_velocities(velocities, workspace, size, OF_BEFORE)
            put_first(contacts, count, workspace)
        for c in range(count):
            best = workspace.inside[c]
            set_impulse(contacts[c], velocities, best[BEST], best[BEST + 1], best[BEST + 2])
        return made

    return separate(kernel(begin_again, spec), spec, SELDOM)
