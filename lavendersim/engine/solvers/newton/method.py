"""Newton's method on the augmented Lagrangian of a contact problem, factorised over the bodies.

Around impulses lambda^k the next ones respond to velocities v as stiff dampers do (`response`),
    lambda(v) = proj(lambda^k - E (J v + b + s)),    E = 1/(softness k) per row,
onto Coulomb's cone, with De Saxce's shift s = mu |v_t^k| along the normal, without which the
projection onto the cone would lift what slides. Kept for a round, it leaves a convex problem
(`minimise`). At rest s = 0, and a round shrinks the error by softness over the least
eigenvalue of the scaled Delassus operator; where that is not what a round leaves, the shifts are,
and the next ones go by their secants, each by its own, then all together (`shifts`). A round must
end exactly: what it leaves undone comes back in the impulses, times E. Torques take part
(`torques`).

The first round is stiff and takes contacts to be at rest: a load that is carried without slip is
found at once, through a tower or a pyramid. Where that fails, rounds begin soft, where few contacts
change their minds at a time, and stiffen.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any

from ...anderson import NO_ROUND
from ...compile import inner, kernel, separate
from ...contact import make_apply_block
from ...residual import make_residual
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import lay_out
from .factor import eliminates, make_lay_out
from .kept_velocities import (
    LOST,
    OF_BEST,
    OF_START,
    make_keep_velocities,
    make_put_velocities,
    make_speed,
)
from .minimise import make_assemble_mass, make_minimise
from .response import PLAIN, SECANT, TOGETHER, make_projected_impulse, make_start
from .rounds import (
    EXACTNESS,
    FAILURES,
    SOFTEST,
    after_failed,
    after_kept,
    after_stalled,
    back_to,
    begin_rounds,
    is_kept,
)
from .shifts import PATIENCE, make_shift_together
from .torques import make_accept_torques, make_keep_torques, make_restore_torques

# Newton steps in a call; fewer than these are not worth beginning.
MOST_STEPS = 150
FEWEST_STEPS = 12.0
# Softness of the first round where contacts are taken to be at rest [-].
STICKING = 1e-6
# Above this share of the residual before it, a round has stalled: it is the shifts that are off.
STALLED = 0.3
# Multiplications per contact in a step, beside the factorisation.
ASSEMBLY = 1000


def make_restore(spec: Spec, which: str, set_impulse: Any, torques: bool = True) -> Any:
    """Return `kernel(contacts, count, velocities)`: impulses and torques as they were kept.

    which: at the `start` of the round, or the `best` so far; velocities follow. torques: whether
    they are restored, too.
    """
    friction, spins = row_terms(spec).frictional, torques and resists_turning(spec)
    restore_torques = make_restore_torques(spec, which)
    kept_n, kept_1, kept_2 = (f"{which}_{axis}" for axis in "n12")

    def restore(contacts, count, velocities):
        for c in range(count):
            contact = contacts[c]
            one, two = 0.0, 0.0
            if friction:
                one, two = contact[kept_1], contact[kept_2]
            set_impulse(contact, velocities, contact[kept_n], one, two)
            if spins:
                restore_torques(contact, velocities[contact.a], velocities[contact.b])

    restore.__name__ = f"restore_{which}"  # as `lavender plan` lists them
    restore.__qualname__ += f"_{which}"
    return kernel(restore, spec)


def make_set_impulse(spec: Spec):
    """Return `kernel(contact, velocities, n, one, two)`: new impulses, and velocities with them."""
    friction, apply_block = row_terms(spec).frictional, make_apply_block(spec)

    def set_impulse(contact, velocities, n, one, two):
        change_n, change_1, change_2 = n - contact.lambda_n, 0.0, 0.0
        contact.lambda_n = n
        if friction:
            change_1, change_2 = one - contact.lambda_1, two - contact.lambda_2
            contact.lambda_1, contact.lambda_2 = one, two
        va, vb = velocities[contact.a], velocities[contact.b]
        apply_block(contact, va, vb, change_n, change_1, change_2)

    return kernel(set_impulse, spec)


def make_accept(spec: Spec, set_impulse: Any, projected_impulse: Any):
    """Return `kernel(contacts, count, velocities)`: what a round ends with in place of those now.

    projected_impulse: kernel of a contact's response.
    """
    friction, spins = row_terms(spec).frictional, resists_turning(spec)
    accept_torques = make_accept_torques(spec)

    def accept(contacts, count, velocities):
        for c in range(count):
            contact = contacts[c]
            n, one, two = projected_impulse(contact, 0.0)
            if friction:  # round-off may have left the cone
                limit = contact.mu * n
                squared = one * one + two * two
                if squared > limit * limit:
                    scale = limit / sqrt(squared)
                    one, two = one * scale, two * scale
            set_impulse(contact, velocities, n, one, two)
            if spins:
                accept_torques(contact, velocities[contact.a], velocities[contact.b])

    return kernel(accept, spec)


def make_keep(spec: Spec):
    """Return `kernel(contacts, count)`: the impulses of now are the `best` so far."""
    friction, spins = row_terms(spec).frictional, resists_turning(spec)
    keep_torques = make_keep_torques(spec)

    def keep(contacts, count):
        for c in range(count):
            contact = contacts[c]
            contact.best_n = contact.lambda_n
            if friction:
                contact.best_1, contact.best_2 = contact.lambda_1, contact.lambda_2
            if spins:
                keep_torques(contact)

    return kernel(keep, spec)


def _step_cost_by(lay_out: Any) -> Any:
    def step_cost(system, workspace):
        size, entries, work = lay_out(system.contacts, system.count, workspace)
        if size == 0 or entries > workspace.values.shape[0]:
            return size, inf
        return size, float(work + ASSEMBLY * system.count)

    return step_cost


# `kernel(system, workspace)` -> unknown bodies, multiplications of a step: infinite for what the
# arrays cannot hold. What it lays out in the workspace is what `make_newton`'s kernel begins with.
# No impulse is read: it holds for a whole solve.
step_cost = inner(_step_cost_by(lay_out))


def make_step_cost(spec: Spec) -> Any:
    """Return `step_cost` for an engine, with the order of its bodies that costs less."""
    if not eliminates(spec):
        return step_cost
    return kernel(_step_cost_by(make_lay_out(spec)), spec)


def make_newton(spec: Spec):
    """Return `kernel(system, workspace, size, most, tolerance, sticking_guess)`.

    size: of `step_cost`; most: steps. It returns the number of steps made and whether the sticking
    guess, that all contacts are at rest, still holds. Impulses, torques and velocities leave
    consistent with each other.
    """
    residual, start = make_residual(spec), make_start(spec)
    assemble_mass, minimise = make_assemble_mass(spec), make_minimise(spec)
    set_impulse, keep = make_set_impulse(spec), make_keep(spec)
    accept = make_accept(spec, set_impulse, make_projected_impulse(spec))
    restore_start = make_restore(spec, "start", set_impulse)
    restore_best = make_restore(spec, "best", set_impulse)
    begin, kept = kernel(begin_rounds, spec), kernel(is_kept, spec)
    go_on, go_softer = kernel(after_kept, spec), kernel(after_failed, spec)
    back: Any = kernel(back_to, spec)
    stay, slides = kernel(after_stalled, spec), row_terms(spec).frictional
    keep_velocities, put_velocities = make_keep_velocities(spec), make_put_velocities(spec)
    speed = make_speed(spec)
    shift_together: Any = make_shift_together(spec)

    def newton(system, workspace, size, most, tolerance, sticking_guess):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        assemble_mass(system.bodies, size, workspace)
        # A gain of dI^2 softness k / 2 is what an impulse dI off the minimum costs.
        lightest = 1.0 / contacts[0].k_n
        for c in range(count):
            lightest = min(lightest, 1.0 / contacts[c].k_n)
        least, _ = residual(contacts, count, velocities)
        now, stalls = least, PLAIN
        stalled, columns = 0, NO_ROUND
        keep(contacts, count)
        keep_velocities(velocities, workspace, size, OF_BEST)
        usual, peak = speed(contacts, count, velocities), 0.0
        rounds = begin(STICKING if sticking_guess else SOFTEST)
        lowest = rounds.good  # softness of the round that left the least
        steps, guess_holds, went_back = 0, sticking_guess, False
        while steps < most:
            off = max(least, tolerance)
            at_rest = sticking_guess and steps == 0
            softness = rounds.softness
            if slides:
                if stalled >= PATIENCE:
                    columns = shift_together(contacts, count, velocities, workspace.shifts, columns)
                    stalls = TOGETHER
            start(contacts, count, velocities, softness, at_rest, stalls)
            keep_velocities(velocities, workspace, size, OF_START)
            made, found = minimise(
                contacts, count, size, workspace, EXACTNESS * softness * lightest * off * off
            )
            steps += made
            keeps = False
            if found:  # impulses of no minimum would be as large as E
                accept(contacts, count, velocities)
                peak = max(peak, speed(contacts, count, velocities))
                largest, _ = residual(contacts, count, velocities)
                if largest <= tolerance:
                    now = least = largest
                    break
                keeps = kept(largest, least, at_rest)
                if keeps:
                    stalls = SECANT if largest > STALLED * now else PLAIN
                    stalled += stalls
                    now = largest
                    if largest <= least:
                        least, lowest = largest, softness
                        keep(contacts, count)
                        keep_velocities(velocities, workspace, size, OF_BEST)
                    rounds = stay(rounds) if stalled >= PATIENCE and slides else go_on(rounds)
                else:
                    restore_start(contacts, count, velocities)
                    if peak > LOST * usual:
                        put_velocities(velocities, workspace, size, OF_START)
            if not keeps:
                # What a guess of rest led to says nothing of how fast softness may fall.
                rounds = go_softer(rounds, at_rest)
                if rounds.failed > FAILURES:
                    if now <= least or went_back:
                        break
                    # Rounds since the least went astray: from there on they are as soft as it was.
                    restore_best(contacts, count, velocities)
                    if peak > LOST * usual:
                        put_velocities(velocities, workspace, size, OF_BEST)
                    now, stalls, stalled, columns = least, PLAIN, 0, NO_ROUND
                    rounds, went_back = back(rounds, lowest), True
                if stalls == TOGETHER:  # what led to it is no guide
                    stalls, stalled, columns = PLAIN, 1, NO_ROUND
                if at_rest:
                    guess_holds = False
        if now > least:
            restore_best(contacts, count, velocities)
            if peak > LOST * usual:
                put_velocities(velocities, workspace, size, OF_BEST)
        return steps, guess_holds

    return separate(kernel(newton, spec), spec)
