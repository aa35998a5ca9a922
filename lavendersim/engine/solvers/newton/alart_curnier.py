"""Newton's method on Coulomb's law itself, where rounds of convex problems do not end (`method`).

The convex rounds have De Saxce's shifts beside them, as a fixed point. Where more points hold than
needed, and slide as they turn, shifts that are off by as little as 1e-6 m/s say which of the points
opens, and the fixed point has no slope. So a round here has no shift: normal and tangential
impulses respond to velocities each by its own law (Alart and Curnier 1991),
    lambda_n = max(0, lambda_n^k - E w_n),    lambda_t = proj(lambda_t^k - E w_t),
onto the disc of radius mu lambda_n, around the impulses lambda^k of the round before, with
E = 1/(softness k) per row. As lambda_t follows lambda_n, M + J^T E' J is not symmetric (`lu`).

No function falls along such a step, and one that measured the imbalance would bar the way of what
points in excess trade: steps are whole, a round is kept by its residual. Softness falls from round
to round, by less after one that fails, which is followed by one as soft as the last that was kept:
where points in excess ask for what contradicts by w, each round shifts impulses between them by
E w, until one of them opens, and only then the residual falls.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any

from ...compile import kernel
from ...residual import make_residual
from ...row_terms import row_terms
from ...spec import Spec
from .coulomb_response import (
    make_coulomb_impulse,
    make_coulomb_stiffness,
    make_scale_by_coulomb,
    make_scale_transposed,
)
from .envelope import DOF
from .factor import make_solve_lu
from .kept_velocities import (
    LOST,
    OF_BEST,
    OF_START,
    make_keep_velocities,
    make_put_velocities,
    make_speed,
)
from .matrix import make_assemble_and_factorise
from .method import make_accept, make_keep, make_restore, make_set_impulse
from .minimise import (
    make_assemble_mass,
    make_begin,
    make_directional_derivative,
    make_gather,
    make_take_step,
)
from .response import PLAIN, make_start
from .rounds import EXACTNESS, STIFFEST

# Steps of a round at most: those that find every contact's state take a few.
STEPS_OF_A_ROUND = 12
# So many times the least change so far, from the fifth step on, says that a round has no end [-].
STEPS_BEFORE, GROWN = 4, 10.0
# Softness falls by this factor from round to round, by its root after one that failed [-].
CUT = 0.3
# Rounds that may fail before the method is given up.
FAILURES = 30
# Where the first round fails softness rises by this factor, up to the most [-].
SOFTER, MOST_SOFT = 10.0, 0.3
# A round may leave the residual this much above the least so far [-].
WORSE = 3.0
# A round that brings the residual below the tolerance, and by no more than to this share of what
# it was, is the last: what is left is round-off [-].
BROUGHT = 0.3
# Changes of velocities by round-off, as a share of the velocities [-].
ROUND_OFF = 1e-14


def make_find_root(spec: Spec) -> Any:
    """Return `kernel(contacts, count, size, workspace, enough) -> (steps, found)`.

    Contacts have their `start` impulses, and their `velocity` is brought to where momentum balances
    what they respond with; enough: change of their velocities by the last step [m/s].
    """
    coulomb_impulse, stiffness = make_coulomb_impulse(spec), make_coulomb_stiffness(spec)
    scales = make_scale_by_coulomb(spec), make_scale_transposed(spec)
    assemble_and_factorise = make_assemble_and_factorise(spec, stiffness, scales)
    begin, gather = make_begin(spec), make_gather(spec, coulomb_impulse)
    directional_derivative = make_directional_derivative(spec)
    take_step, mixed = make_take_step(spec), row_terms(spec).frictionless
    solve_lu = make_solve_lu(spec)

    def fastest(contacts, count):
        found = 0.0
        for c in range(count):
            contact = contacts[c]
            found = max(found, abs(contact.velocity_n))
            tangents = True  # a row of a normal has none: what stands there is of another
            if mixed:
                tangents = contact.frictional == 1
            if tangents:
                found = max(found, abs(contact.velocity_1), abs(contact.velocity_2))
        return found

    fastest = kernel(fastest, spec)

    def greatest_change(contacts, count):
        found = 0.0
        for c in range(count):
            contact = contacts[c]
            change, tangents = abs(contact.step_n), True
            if mixed:
                tangents = contact.frictional == 1
            if tangents:
                change = max(change, abs(contact.step_1), abs(contact.step_2))
            if change > found or change != change:
                found = change
        return found

    greatest_change = kernel(greatest_change, spec)

    def find_root(contacts, count, size, workspace, enough):
        begin(contacts, count, size, workspace)
        enough = max(enough, ROUND_OFF * fastest(contacts, count))
        least = inf
        for done in range(STEPS_OF_A_ROUND):
            gather(contacts, count, size, workspace)
            if not assemble_and_factorise(contacts, count, size, workspace):
                return done + 1, False
            for r in range(DOF * size):
                workspace.step[r] = -workspace.gradient[r]
            solve_lu(size, workspace, workspace.step)
            directional_derivative(contacts, count, workspace)
            change = greatest_change(contacts, count)
            if change != change or (done >= STEPS_BEFORE and change > GROWN * least):
                return done + 1, False
            least = min(least, change)
            take_step(contacts, count, size, workspace, 1.0)
            if change <= enough:
                return done + 1, True
        return STEPS_OF_A_ROUND, False

    return kernel(find_root, spec)


def make_alart_curnier(spec: Spec) -> Any:
    """Return `kernel(system, workspace, size, most, residuals, softness) -> steps`.

    size: of `step_cost`; most: steps; residuals: to be reached, at best and at least, where the
    latter is not yet [m/s]; softness: of the first round [-]. Impulses, torques, velocities leave
    consistent with each other, at the least residual. None without friction: convex rounds have no
    shifts there.
    """
    if not row_terms(spec).frictional:
        return None
    residual, start = make_residual(spec), make_start(spec)
    assemble_mass, find_root = make_assemble_mass(spec), make_find_root(spec)
    set_impulse, keep = make_set_impulse(spec), make_keep(spec)
    accept = make_accept(spec, set_impulse, make_coulomb_impulse(spec))
    restore_start = make_restore(spec, "start", set_impulse)
    restore_best = make_restore(spec, "best", set_impulse)
    keep_velocities, put_velocities = make_keep_velocities(spec), make_put_velocities(spec)
    speed = make_speed(spec)

    def alart_curnier(system, workspace, size, most, residuals, softness):
        tolerance, enough = residuals
        contacts, count, velocities = system.contacts, system.count, system.velocities
        assemble_mass(system.bodies, size, workspace)
        least, _ = residual(contacts, count, velocities)
        if least <= enough:
            return 0
        now = least
        keep(contacts, count)
        keep_velocities(velocities, workspace, size, OF_BEST)
        usual, peak = speed(contacts, count, velocities), 0.0
        cut, good, again = CUT, 0.0, False
        steps, failed = 0, 0
        while steps < most and failed < FAILURES and softness <= MOST_SOFT:
            # Taken to be at rest, contacts have no shift.
            start(contacts, count, velocities, softness, True, PLAIN)
            keep_velocities(velocities, workspace, size, OF_START)
            exact = EXACTNESS * softness * max(least, tolerance)
            made, found = find_root(contacts, count, size, workspace, exact)
            steps += made
            kept = False
            if found:  # impulses of no root would be as large as E
                accept(contacts, count, velocities)
                peak = max(peak, speed(contacts, count, velocities))
                largest, _ = residual(contacts, count, velocities)
                kept = largest <= WORSE * least
                if kept:
                    before, now = now, largest
                    if largest < least:
                        least = largest
                        keep(contacts, count)
                        keep_velocities(velocities, workspace, size, OF_BEST)
                    if least <= tolerance or (least <= enough and largest > BROUGHT * before):
                        break
                    good, softness = softness, max(softness * cut, STIFFEST)
                    if not again:
                        cut = max(cut * cut, CUT)
                    again = False
                else:
                    restore_start(contacts, count, velocities)
                    if peak > LOST * usual:
                        put_velocities(velocities, workspace, size, OF_START)
            if not kept:
                failed += 1
                if good == 0.0:
                    softness *= SOFTER
                else:
                    # As soft as the last that was kept: what is in excess moves on by it.
                    if again:
                        good /= CUT
                    else:
                        cut = sqrt(cut)
                    softness, again = good, True
        if now > least:
            restore_best(contacts, count, velocities)
            if peak > LOST * usual:
                put_velocities(velocities, workspace, size, OF_BEST)
        return steps

    return kernel(alart_curnier, spec)
