"""Contact rows at the middle of the step (`effects.contact_midpoint`): which last, what they ask.

lasting   which contacts may last; their slip at the start of the step
shift     what a row asks beyond v_n + target >= 0, once it is completed at the middle
widen     the same of one that does not last, across a gap
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .block import make_relative_velocity, make_slip_velocity
from .collide.shapes import make_is_inside
from .compile import inner, kernel
from .contact import make_normal_velocity
from .effects import has_hook, made_once
from .joint_turn import make_joint_velocity
from .records import PLANE, ROPE
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, dot, length

# Change of a surface's velocity in half a step that a row may miss [m/s]: what solves leave.
SAME = 1e-9
# What moves slower changes no geometry, whatever turns [m/s].
STILL = 100.0 * SAME
# What approaches or parts slower does neither: it lasts [m/s].
CALM = 100.0 * SAME
# A contact lasts that begins to approach or part no faster than these shares: of what forces
# change in a step, and of what the turning of its surfaces changes in half a step.
FORCED, TURNED = 0.05, 0.5
# One that did not last in the step before parts by what the turning changed in it, twice that of
# half a step: were that too fast, it would never last.
BEFORE = 2.5
# It may have a gap of this share of what the turning of its surfaces moves them by.
AJAR = 0.25
# Ends of a joint that did not stay together at the last middle, and that part by more than this
# share of what their turning parts them by half a step later, are torn: their mean velocity in the
# step is half of that, not none [-].
TORN = 0.5
# It slides throughout when the slip is so many times its change.
SLIDES = 2.0


def make_is_moving(spec: Spec) -> Any:
    """Return `kernel(bodies, motion) -> whether anything moves as the step begins`."""
    turns = step_terms(spec).turns

    def is_moving(bodies, motion):
        for i in range(motion.shape[0]):
            m = motion[i]
            squared = m.vx * m.vx + m.vy * m.vy + m.vz * m.vz
            if turns:
                if bodies[i].shape != PLANE:
                    spin = m.wx * m.wx + m.wy * m.wy + m.wz * m.wz
                    squared += bodies[i].bound * bodies[i].bound * spin
            if squared > STILL * STILL:
                return True
        return False

    return kernel(is_moving, spec)


def make_note_restrained(spec: Spec) -> Any:
    """Return `kernel(contacts, count, pairs, bodies, motion, slop)`: what is restrained, noted.

    By a joint, a spring, or a touch of what does not move: known before any row is, and the same
    in all passes, or these would lead to no middle.
    """
    springs, bilateral = has_hook(spec, "act_beside"), row_terms(spec).bilateral

    def note_restrained(contacts, count, pairs, bodies, motion, slop):
        for i in range(motion.shape[0]):
            motion[i].restrained = 0
            if springs:
                if bodies[i].sprung > 0:
                    motion[i].restrained = 1
        for c in range(count):
            contact = contacts[c]
            a, b = contact.a, contact.b
            holds = contact.phi <= slop and (bodies[a].inv_m == 0.0 or bodies[b].inv_m == 0.0)
            if bilateral:
                holds = holds or pairs[contact.pair].kind < ROPE
            if holds:
                motion[a].restrained, motion[b].restrained = 1, 1

    return kernel(note_restrained, spec)


@inner
def is_free(contact, motion):
    """Return 1 where neither body is restrained, else 0."""
    return 1 if motion[contact.a].restrained == 0 and motion[contact.b].restrained == 0 else 0


def make_lasting(spec: Spec) -> Any:
    """Return `kernel(contact, pair, velocities, motion, params)`, of a row completed at the start.

    Whether it lasts, by how fast its surfaces approach before forces act. velocities: after them.
    """
    friction = row_terms(spec).frictional
    springs, spring_row = made_once(spec, "spring_row")
    ropes, bilateral = row_terms(spec).taut, row_terms(spec).bilateral
    inside, is_inside = make_is_inside(spec)
    yielding = row_terms(spec).yielding
    turns, normal_velocity = step_terms(spec).turns, make_normal_velocity(spec)

    def is_twisted(v, m):
        return v.wx != m.wx or v.wy != m.wy or v.wz != m.wz

    twisted: Any = kernel(is_twisted, spec) if turns else None

    def lasting(contact, pair, velocities, motion, params):
        contact.begin_n = contact.v_n_pre - contact.dv_n
        if turns:
            a, b = contact.a, contact.b
            if twisted(velocities[a], motion[a]) or twisted(velocities[b], motion[b]):
                # dv_n is without what torques change.
                contact.begin_n = normal_velocity(contact, motion[a], motion[b])
                if springs:
                    if contact.spring_compliance > 0.0:
                        spring_row(contact, contact.begin_n, params)
        contact.middle_n = contact.begin_n
        forced = abs(contact.dv_n) * params.timestep / params.dt
        closed = contact.phi <= params.slop
        closes, opens = FORCED * forced + CALM, CALM
        if ropes:
            if contact.span > 0.0:  # its ends swing by as much to either side of its length
                closes = opens = FORCED * contact.stirred + CALM
        if inside:
            if is_inside(pair.kind):  # its wall turns back what parts so slowly
                opens = FORCED * forced + CALM
        calm = -closes <= contact.begin_n <= opens
        contact.lasts, contact.jumps = 1 if closed and calm else 0, 0
        if springs:
            if contact.spring_compliance > 0.0:  # its force has no jump
                contact.lasts = 1
        if bilateral:
            if contact.bilateral == 1:
                contact.lasts, contact.torn = 1, -1
        if friction:
            contact.slides = 0
            if yielding:
                if contact.yield_k > 0.0:  # its row has the sum of both ends' slips
                    contact.slides = 2

    return kernel(lasting, spec)


def make_begin_slip(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, motion) -> whether the slip turns`.

    Of rows solved at the start: their slip then, and whether it counts in the mean: where they
    slide throughout, or where friction would else do work on it, that of all rows of a pair: of
    those that stick alone it is only the sum that statics tells. None without friction.
    """
    if not row_terms(spec).frictional:
        return None
    relative_velocity, stretched = make_relative_velocity(spec), row_terms(spec).stretched
    yielding = row_terms(spec).yielding

    def work_on_slip(contact):
        x, y, z = contact.begin_x, contact.begin_y, contact.begin_z
        one = contact.lambda_1 * (contact.t1x * x + contact.t1y * y + contact.t1z * z)
        return one + contact.lambda_2 * (contact.t2x * x + contact.t2y * y + contact.t2z * z)

    work_on_slip = kernel(work_on_slip, spec)

    def begin_slip(contacts, count, velocities, motion):
        turned, first, work = False, 0, 0.0
        for c in range(count):
            contact = contacts[c]
            if contact.pair != contacts[first].pair:
                first, work = c, 0.0
            x, y, z = relative_velocity(contact, motion[contact.a], motion[contact.b])
            v = relative_velocity(contact, velocities[contact.a], velocities[contact.b])
            dx, dy, dz = v[0] - x, v[1] - y, v[2] - z
            one, two = contact.surface_1, contact.surface_2
            if stretched:
                one, two = one * contact.ease_1, two * contact.ease_2
            x += contact.t1x * one + contact.t2x * two
            y += contact.t1y * one + contact.t2y * two
            z += contact.t1z * one + contact.t2z * two
            contact.begin_x, contact.begin_y, contact.begin_z = x, y, z
            slip, change = sqrt(x * x + y * y + z * z), sqrt(dx * dx + dy * dy + dz * dz)
            contact.slides = 1 if slip > SLIDES * change else 0
            yields = False
            if yielding:
                yields = contact.yield_k > 0.0
            if yields:  # its row is of the mean slip
                contact.slides = 2
            elif contact.slides == 0:
                work += work_on_slip(contact)
            elif contact.lambda_n > 0.0:
                across_x, across_y = y * dz - z * dy, z * dx - x * dz
                across_z = x * dy - y * dx
                across = sqrt(across_x * across_x + across_y * across_y + across_z * across_z)
                if across > SAME * slip:
                    turned = True
            is_last = c + 1 == count or contacts[c + 1].pair != contact.pair
            if is_last and work > 0.0:
                for k in range(first, c + 1):
                    if contacts[k].slides == 0 and work_on_slip(contacts[k]) > 0.0:
                        contacts[k].slides = 1
        return turned

    return kernel(begin_slip, spec)


def make_is_unparted(spec: Spec) -> Any:
    """Return `kernel(contact, motion) -> whether` its bodies that move were `unparted` before."""

    def is_unparted(contact, motion):
        unparted = True
        if contact.inv_m_a > 0.0:
            unparted = motion[contact.a].unparted == 1
        if contact.inv_m_b > 0.0:
            unparted = unparted and motion[contact.b].unparted == 1
        return unparted

    return kernel(is_unparted, spec)


def make_note_unparted(spec: Spec) -> Any:
    """Return `kernel(motion, midway)`, of a part that took time: whose joints stay together."""

    def note_unparted(motion, midway):
        for i in range(motion.shape[0]):
            motion[i].unparted = motion[i].midway if midway else 0

    return kernel(note_unparted, spec)


def make_resist(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities) -> whether a row more slides in the mean`.

    Of rows solved at the middle. Where friction has turned since the solve at the start it may push
    along the slip that the step began with, and the rows of a pair would do work on the mean:
    lambda_t . (w + s_0)/2. There that slip counts, too, as in `begin_slip`; not of what is driven,
    which does work on what rides on it. None without friction.
    """
    if not row_terms(spec).frictional:
        return None
    slip_velocity, turns = make_slip_velocity(spec), step_terms(spec).turns

    def is_driven(inv_m, v):
        moves = v.vx != 0.0 or v.vy != 0.0 or v.vz != 0.0
        if turns:
            moves = moves or v.wx != 0.0 or v.wy != 0.0 or v.wz != 0.0
        return inv_m == 0.0 and moves

    is_driven = kernel(is_driven, spec)

    def work_on_mean(contact, velocities):
        # lambda_t . (w + s_0) of a row, and what of it is round-off.
        one, two = contact.lambda_1, contact.lambda_2
        _, v_1, v_2 = slip_velocity(contact, velocities[contact.a], velocities[contact.b])
        x, y, z = contact.begin_x, contact.begin_y, contact.begin_z
        s_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        s_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        return one * (v_1 + s_1) + two * (v_2 + s_2), SAME * sqrt(one * one + two * two)

    work_on_mean = kernel(work_on_mean, spec)

    def resist(contacts, count, velocities):
        more, first, work, least = False, 0, 0.0, 0.0
        for c in range(count):
            contact = contacts[c]
            if contact.pair != contacts[first].pair:
                first, work, least = c, 0.0, 0.0
            va, vb = velocities[contact.a], velocities[contact.b]
            sticks = contact.lasts == 1 and contact.slides == 0 and contact.lambda_n != 0.0
            if is_driven(contact.inv_m_a, va) or is_driven(contact.inv_m_b, vb):
                continue
            if sticks:
                own, rounding = work_on_mean(contact, velocities)
                work, least = work + own, least + rounding
            is_last = c + 1 == count or contacts[c + 1].pair != contact.pair
            if is_last and work > least:
                for k in range(first, c + 1):
                    row = contacts[k]
                    if row.lasts == 1 and row.slides == 0 and row.lambda_n != 0.0:
                        own, rounding = work_on_mean(row, velocities)
                        if own > rounding:
                            row.slides, more = 1, True
        return more

    return kernel(resist, spec)


def make_shift(spec: Spec) -> Any:
    """Return `kernel(contact, pair, lead, motion, params)`, of a row at the middle: its b."""
    terms = row_terms(spec)
    friction, frictionless = terms.frictional, terms.frictionless
    springs, spring_row = made_once(spec, "spring_row")
    yielding = terms.yielding
    swept, ropes = row_terms(spec).swept, row_terms(spec).taut
    bilateral, bounded = terms.bilateral, terms.bounded
    joint_velocity: Any = make_joint_velocity(spec) if bilateral else None
    normal_velocity = make_normal_velocity(spec)
    relative_velocity = make_relative_velocity(spec)
    is_unparted: Any = make_is_unparted(spec) if bilateral else None
    inside, is_inside = make_is_inside(spec)

    def shift(contact, pair, lead, motion, params):
        la, lb = lead[contact.a], lead[contact.b]
        contact.middle_n = normal_velocity(contact, la, lb)
        if bilateral:
            if contact.bilateral == 1:
                contact.lasts = 1
                if bounded:
                    if contact.motor == 1:
                        contact.driven = contact.middle_n
                        contact.target += contact.middle_n - contact.begin_n
                        return
                contact.target = contact.middle_n
                # Of a joint that an impact or its first velocities tear, nothing is thrown back.
                # The first middle says so: a row that changed its mind would have no fixed point.
                # All rows of a point leave it the same velocity, or they would contradict.
                # What the middle before left is no tear, however slowly its bodies turn by now: a
                # row that left it would do work.
                parting = Vec3(contact.parting_x, contact.parting_y, contact.parting_z)
                if contact.torn < 0:
                    ahead = length(joint_velocity(contact, la, lb))
                    contact.torn = 1 if length(parting) > TORN * ahead else 0
                    if is_unparted(contact, motion):
                        contact.torn = 0
                if contact.torn == 1:
                    contact.target -= dot(Vec3(contact.nx, contact.ny, contact.nz), parting)
                return
        kept = min(contact.begin_n, 0.0)
        if ropes:
            # What its ends approach by is no mode to damp: it is what keeps length and energy.
            if contact.span > 0.0:
                kept = 0.0
        if inside:
            if is_inside(pair.kind):  # as of a rope
                kept = 0.0
        b = contact.middle_n - kept
        ajar = max(contact.phi - params.slop, 0.0)
        forced = abs(contact.dv_n) * params.timestep / params.dt
        turned = TURNED * abs(b) + CALM
        left = BEFORE * (contact.middle_n - contact.begin_n) + CALM
        contact.lasts = 0
        soft = False
        if springs:
            soft = contact.spring_compliance > 0.0
        closes, opens = FORCED * forced + turned, max(turned, left)
        if ropes:
            if contact.span > 0.0:
                closes = opens = FORCED * contact.stirred + turned
        if inside:
            if is_inside(pair.kind):
                opens = FORCED * forced + turned
        calm = -closes <= contact.begin_n <= opens
        if not soft and (not calm or ajar > AJAR * params.dt * abs(b)):
            return
        if swept:  # its gap is that along the normal of where bodies pass each other, not theirs
            aside = abs(contact.at_tx) + abs(contact.at_ty) + abs(contact.at_tz)
            if not soft and ajar > 0.0 and aside > 0.0:
                return
        contact.lasts = 1
        if soft:
            if springs:
                spring_row(contact, contact.middle_n, params)
        elif ajar > 0.0:
            contact.target = ajar / params.dt + b
        else:
            contact.target += b
        if friction:
            frictional, yields = True, False
            if frictionless:
                frictional = contact.frictional == 1
            if yielding:
                yields = contact.yield_k > 0.0
            if yields:  # its row has the slip of the start but for how uneven bodies turn
                x, y, z = relative_velocity(contact, la, lb)
                s = relative_velocity(contact, motion[contact.a], motion[contact.b])
                x, y, z = x - s[0], y - s[1], z - s[2]
                contact.surface_1 += contact.t1x * x + contact.t1y * y + contact.t1z * z
                contact.surface_2 += contact.t2x * x + contact.t2y * y + contact.t2z * z
                contact.slides = 2
            elif frictional:
                x, y, z = relative_velocity(contact, la, lb)
                sx, sy, sz = contact.begin_x, contact.begin_y, contact.begin_z
                one = contact.t1x * x + contact.t1y * y + contact.t1z * z + contact.surface_1
                two = contact.t2x * x + contact.t2y * y + contact.t2z * z + contact.surface_2
                if contact.slides > 0:
                    contact.slides = 2
                else:
                    one -= contact.t1x * sx + contact.t1y * sy + contact.t1z * sz
                    two -= contact.t2x * sx + contact.t2y * sy + contact.t2z * sz
                contact.surface_1 += one
                contact.surface_2 += two

    return kernel(shift, spec)
