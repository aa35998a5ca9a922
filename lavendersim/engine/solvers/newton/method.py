"""Newton's method on the augmented Lagrangian of a contact problem, factorised over the bodies.

Around impulses lambda^k the next ones answer velocities v as stiff dampers would (`response`),
    lambda(v) = proj(lambda^k - E (J v + b + s)),    E = 1/(softness k) per row,
onto Coulomb's cone, with De Saxce's shift s = mu |v_t^k| along the normal, without which the
projection onto the cone would lift what slides. Held for a round, it leaves a convex problem
(`minimise`). At rest s = 0, and a round shrinks the error by softness over the least
eigenvalue of the scaled Delassus operator; where that is not what a round leaves, the shifts are,
and the next ones go by their secants. A round must end exactly: what it leaves undone comes back in
the impulses, times E. Torques take part (`torques`).

The first round is stiff and takes contacts to be at rest: a load that is carried without slip is
found at once, through a tower or a pyramid. Where that fails, rounds begin soft, where few contacts
change their minds at a time, and stiffen.
"""

from __future__ import annotations

from math import sqrt

from ...compile import kernel
from ...contact import make_apply_block
from ...residual import make_residual
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import lay_out
from .minimise import make_minimise, make_weigh
from .response import make_answer, make_start
from .torques import make_keep_torques, make_put_torques, make_restore

# Newton steps in a call; fewer than these are not worth beginning.
MOST_STEPS = 150
FEWEST_STEPS = 12.0
# Softness of the first round, of the second where the first failed, and the least [-].
BOLD = 1e-6
SOFTEST = 1e-2
STIFFEST = 1e-8
# Softness falls by this factor from round to round, by its root after one that failed: the same
# round again would fail again [-].
CUT = 0.03
# Rounds that may fail before sweeps go on.
FAILURES = 6
# A round may leave the largest residual this much above the least so far: it falls on average. What
# is handed on is the least.
WORSE = 10.0
# Above this share of the residual before it, a round has stalled: it is the shifts that are off.
STALLED = 0.3
# The first round has to bring it down to this share, or what it took to be at rest slides.
REST = 0.1
# A round's impulses may be this share of the residual, squared, off the minimum's [-].
EXACTNESS = 0.01
# Multiplications per contact in a step, beside the factorisation.
ASSEMBLY = 1000


def make_newton(spec: Spec):
    """Return `kernel(contacts, count, bodies, velocities, space, tolerance, allowance, bold)`.

    It returns the number of steps, none when the system is larger than its arrays and no more than
    fit into `allowance` multiplications, and whether the first round held, `bold`: taken to be at
    rest. Impulses, torques and velocities leave consistent with each other.
    """
    friction = spec.has("friction")
    residual, apply_block = make_residual(spec), make_apply_block(spec)
    start, answer = make_start(spec), make_answer(spec)
    weigh, minimise = make_weigh(spec), make_minimise(spec)
    spins = resists_turning(spec)
    put_torques, keep_torques = make_put_torques(spec), make_keep_torques(spec)
    give_back = make_restore(spec, "held")
    go_back_to_torques = make_restore(spec, "best")

    def put(contact, velocities, n, one, two):
        # Impulses in place of those there are, and velocities with them.
        change_n, change_1, change_2 = n - contact.lambda_n, 0.0, 0.0
        contact.lambda_n = n
        if friction:
            change_1, change_2 = one - contact.lambda_1, two - contact.lambda_2
            contact.lambda_1, contact.lambda_2 = one, two
        va, vb = velocities[contact.a], velocities[contact.b]
        apply_block(contact, va, vb, change_n, change_1, change_2)

    put = kernel(put, spec)

    def accept(contacts, count, velocities):
        for c in range(count):
            contact = contacts[c]
            n, one, two = answer(contact, 0.0)
            if friction:  # round-off may have left the cone
                limit = contact.mu * n
                squared = one * one + two * two
                if squared > limit * limit:
                    scale = limit / sqrt(squared)
                    one, two = one * scale, two * scale
            put(contact, velocities, n, one, two)
            if spins:
                put_torques(contact, velocities[contact.a], velocities[contact.b])

    accept = kernel(accept, spec)

    def take_back(contacts, count, velocities):
        for c in range(count):
            contact = contacts[c]
            one, two = 0.0, 0.0
            if friction:
                one, two = contact.held_1, contact.held_2
            put(contact, velocities, contact.held_n, one, two)
            if spins:
                give_back(contact, velocities[contact.a], velocities[contact.b])

    take_back = kernel(take_back, spec)

    def keep(contacts, count):
        # The best impulses so far.
        for c in range(count):
            contact = contacts[c]
            contact.best_n = contact.lambda_n
            if friction:
                contact.best_1, contact.best_2 = contact.lambda_1, contact.lambda_2
            if spins:
                keep_torques(contact)

    keep = kernel(keep, spec)

    def go_back(contacts, count, velocities):
        # To those.
        for c in range(count):
            contact = contacts[c]
            one, two = 0.0, 0.0
            if friction:
                one, two = contact.best_1, contact.best_2
            put(contact, velocities, contact.best_n, one, two)
            if spins:
                go_back_to_torques(contact, velocities[contact.a], velocities[contact.b])

    go_back = kernel(go_back, spec)

    def newton(contacts, count, bodies, velocities, space, tolerance, allowance, bold):
        size, entries, work = lay_out(contacts, count, space)
        if size == 0:
            return 0, bold
        if entries > space.values.shape[0]:
            return 0, bold
        most = min(float(MOST_STEPS), allowance / (work + ASSEMBLY * count))
        if most < FEWEST_STEPS:
            return 0, bold
        weigh(bodies, size, space)
        # A gain of dI^2 softness k / 2 is what an impulse dI off the minimum costs.
        lightest = 1.0 / contacts[0].k_n
        for c in range(count):
            lightest = min(lightest, 1.0 / contacts[c].k_n)
        least, _ = residual(contacts, count, velocities)
        now, stalls = least, False
        keep(contacts, count)
        good, cut = SOFTEST / CUT, CUT
        softness = BOLD if bold else SOFTEST
        steps, failed, held = 0, 0, bold
        while steps < most:
            off = max(least, tolerance)
            at_rest = bold and steps == 0
            start(contacts, count, velocities, softness, at_rest, stalls)
            made, found = minimise(
                contacts, count, size, space, EXACTNESS * softness * lightest * off * off
            )
            steps += made
            better = False
            if found:  # impulses that answer no minimum would be as large as E
                accept(contacts, count, velocities)
                largest, _ = residual(contacts, count, velocities)
                if largest <= tolerance:
                    now = least = largest
                    break
                better = largest < (REST if at_rest else WORSE) * least
                if better:
                    stalls, now, good = largest > STALLED * now, largest, softness
                    if largest <= least:
                        least = largest
                        keep(contacts, count)
                    softness = max(softness * cut, STIFFEST)
                else:
                    take_back(contacts, count, velocities)
            if not better:
                failed += 1
                if failed > FAILURES:
                    break
                if at_rest:
                    held = False
                else:
                    cut = sqrt(cut)
                softness = good * cut
        if now > least:
            go_back(contacts, count, velocities)
        return steps, held

    return kernel(newton, spec)
