"""Positions from velocities: semi-implicit Euler, the midpoint rule, and flight up to an impact.

A body moves through a step in one of three ways:
    free      x += dt v_new, or dt (v_old + v_new)/2 with `midpoint`
    carried   x += dt v_new: a lasting contact pushes it, and v_new is what respects the contact
    impact    on its old velocity until tau, on its new one from there (`impact_time`)
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .body_turn import make_free_turn, make_turn, make_turn_in_halves
from .compile import kernel
from .effects import has_hook, made_once
from .joined_impacts import make_share_impacts
from .records import GIVES, JUMPS, NOT_FINITE, RESTRAINED, SPHERE, TURNS_TOO_FAST
from .rotation import inertia_times, is_round, turn, turn_exactly
from .row_terms import make_acts, row_terms
from .spec import Spec
from .spring_turn import BOTH, PLACED, make_twist
from .step_terms import step_terms
from .vectors import Vec3

# MOTION.carried: a contact carries the body from its impact on, or through the whole step.
AFTERWARDS = 1
ALWAYS = 2
LASTING = 3  # through the whole step, and its surfaces do not approach as it begins
# MOTION.midway: impulses changed its velocity at the middle of the step, or no middle was found.
MIDDLE = 1
UNFOUND = 2
# CONTACT.is_impact: what sets the row's target.
IMPACT = 1  # an impact, at its time
AHEAD = 2  # a gap that bodies fly into after an impact of theirs: reached, if at all, at the end


def keeps_motion(spec: Spec) -> bool:
    """Whether the step needs to know what bodies did before the solve."""
    terms = step_terms(spec)
    return terms.mean_flight or terms.timed_impacts or terms.centred or terms.ahead


def make_note_change(spec: Spec) -> Any:
    """Return `kernel(body, v, m, dt)`: by how much forces changed v, and how far the body gets."""
    torque = step_terms(spec).turns

    def note_change(body, v, m, dt):
        m.dvx, m.dvy, m.dvz = v.vx - m.vx, v.vy - m.vy, v.vz - m.vz
        speed = sqrt(v.vx * v.vx + v.vy * v.vy + v.vz * v.vz)
        if torque:
            speed += body.bound * sqrt(v.wx * v.wx + v.wy * v.wy + v.wz * v.wz)
        m.reach = dt * speed

    return kernel(note_change, spec)


def make_begin(spec: Spec, accelerate: Any) -> Any:
    """Return `kernel(bodies, velocities, motion, params)`: forces act; their effect is noted."""
    torque = step_terms(spec).turns
    kinematic, centred = step_terms(spec).kinematic, step_terms(spec).centred
    note_change = make_note_change(spec)
    prescribed, prescribe = made_once(spec, "prescribe")

    def begin(bodies, velocities, motion, params):
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            m.vx, m.vy, m.vz = v.vx, v.vy, v.vz
            if torque:
                m.wx, m.wy, m.wz = v.wx, v.wy, v.wz
            moves = body.inv_m > 0.0
            if moves:
                accelerate(body, v, params)
            if kinematic:
                if prescribed:
                    if body.kinematic == 1:
                        prescribe(body, v)
                moves = moves or body.kinematic == 1
            m.reach = 0.0
            if centred:
                m.midway = 0
            if moves:
                note_change(body, v, m, params.dt)

    return kernel(begin, spec)


def make_finish(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, motion, params)`: `begin` for what acts between bodies."""
    note_change = make_note_change(spec)

    def finish(bodies, velocities, motion, params):
        for i in range(bodies.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            if body.inv_m > 0.0:
                note_change(body, v, m, params.dt)

    return kernel(finish, spec)


def make_undo(spec: Spec) -> Any:
    """Return `kernel(velocities, motion)`: velocities as before `begin`, for a step begun again."""
    torque = step_terms(spec).turns

    def undo(velocities, motion):
        for i in range(velocities.shape[0]):
            v, m = velocities[i], motion[i]
            v.vx, v.vy, v.vz = m.vx, m.vy, m.vz
            if torque:
                v.wx, v.wy, v.wz = m.wx, m.wy, m.wz

    return kernel(undo, spec)


def make_stand(spec: Spec) -> Any:
    """Return `kernel(velocities, motion)`: in an instant forces change nothing."""

    def stand(velocities, motion):
        for i in range(velocities.shape[0]):
            m = motion[i]
            m.dvx, m.dvy, m.dvz = 0.0, 0.0, 0.0

    return kernel(stand, spec)


def make_classify(spec: Spec) -> Any:
    """Return `kernel(contacts, count, motion, params)`: free, carried or in an impact."""
    at_surface, centred = step_terms(spec).timed_impacts, step_terms(spec).centred
    acts = make_acts(spec)
    joined = at_surface and row_terms(spec).bilateral
    share_impacts: Any = make_share_impacts(spec) if joined else None

    def classify(contacts, count, motion, params):
        abrupt, flown = False, False
        for i in range(motion.shape[0]):
            motion[i].carried, motion[i].tau = 0, params.dt
        for c in range(count):
            contact = contacts[c]
            if acts(contact):
                a, b = motion[contact.a], motion[contact.b]
                kind = 0
                if at_surface:
                    kind = contact.is_impact
                if kind == IMPACT:
                    a.tau, b.tau = min(a.tau, contact.tau), min(b.tau, contact.tau)
                    if contact.separation_speed == 0.0:  # plastic: what meets stays together
                        a.carried = max(a.carried, AFTERWARDS)
                        b.carried = max(b.carried, AFTERWARDS)
                elif kind == AHEAD:
                    flown, abrupt = True, True
                else:
                    lasts = False
                    if centred:
                        lasts = contact.lasts == 1
                    if not lasts:
                        a.carried, b.carried = ALWAYS, ALWAYS
                        abrupt = True
        if joined:
            share_impacts(contacts, count, motion)
        if at_surface:
            if flown:  # what had its impact before flies on to it
                for c in range(count):
                    contact = contacts[c]
                    if acts(contact) and contact.is_impact == AHEAD:
                        a, b = motion[contact.a], motion[contact.b]
                        if a.tau == params.dt:
                            a.carried = ALWAYS
                        if b.tau == params.dt:
                            b.carried = ALWAYS
        if centred:
            for c in range(count):
                contact = contacts[c]
                if acts(contact) and contact.lasts == 1:
                    a, b = motion[contact.a], motion[contact.b]
                    if a.carried == 0 and a.tau == params.dt:
                        a.carried = LASTING
                    if b.carried == 0 and b.tau == params.dt:
                        b.carried = LASTING
            # What is pushed by a body whose velocity jumps, jumps with it.
            while abrupt:
                abrupt = False
                for c in range(count):
                    contact = contacts[c]
                    if acts(contact) and contact.lasts == 1:
                        a, b = motion[contact.a], motion[contact.b]
                        if a.carried == LASTING and b.carried != LASTING:
                            if contact.inv_m_a > 0.0 and contact.inv_m_b > 0.0:
                                a.carried, abrupt = ALWAYS, True
                        elif b.carried == LASTING and a.carried != LASTING:
                            if contact.inv_m_a > 0.0 and contact.inv_m_b > 0.0:
                                b.carried, abrupt = ALWAYS, True

    return kernel(classify, spec)


def make_displace(spec: Spec) -> Any:
    """Return `kernel(body, v, m, dt) -> solved`: the body's displacement in the step."""
    turns = step_terms(spec).turns
    midpoint = step_terms(spec).mean_flight
    springs = midpoint and step_terms(spec).sprung
    twist: Any = make_twist(spec) if springs and turns else None
    at_surface = step_terms(spec).timed_impacts
    uneven, centred = step_terms(spec).uneven, step_terms(spec).centred
    twists = turns and midpoint  # torques of forces and springs; none: the same bits
    free_turn: Any = make_free_turn(spec)
    # A turn leaves the surface of a ball where it is; of other bodies a point of contact moves by
    # the mean spin across its lever as Cayley's map has it.
    exactly = turns and step_terms(spec).substeps
    turn_in_halves: Any = make_turn_in_halves(spec) if turns else None
    turn_by_mean: Any = made_once(spec, "turn_by_mean")[1] if centred and uneven else None
    _, jump = made_once(spec, "add_spin")

    def displace(body, v, m, dt):
        if springs:
            if body.sprung == BOTH:
                body.x += body.shift_x
                body.y += body.shift_y
                body.z += body.shift_z
                if turns:
                    twist(body, v, dt)
                return True
        if at_surface:
            if m.tau < dt:
                rest = dt - m.tau
                # Forces act in flight only: up to the impact, and after it.
                share = 0.0
                if m.carried == 0:
                    share = 0.5 * (m.tau * m.tau - rest * rest) / dt
                elif m.carried == AFTERWARDS:
                    share = 0.5 * m.tau * m.tau / dt
                body.x += m.vx * m.tau + v.vx * rest + share * m.dvx
                body.y += m.vy * m.tau + v.vy * rest + share * m.dvy
                body.z += m.vz * m.tau + v.vz * rest + share * m.dvz
                if turns:
                    gained_x, gained_y, gained_z = v.wx - m.wx, v.wy - m.wy, v.wz - m.wz
                    twice_spent = 0.0
                    if uneven:
                        x, y, z = inertia_times(body, gained_x, gained_y, gained_z)
                        twice_spent = x * gained_x + y * gained_y + z * gained_z
                    v.wx, v.wy, v.wz = m.wx, m.wy, m.wz
                    solved = True
                    if m.tau > 0.0:
                        solved = free_turn(body, v, m.tau)
                    if uneven:
                        jump(body, v, gained_x, gained_y, gained_z, twice_spent)
                    else:
                        v.wx, v.wy, v.wz = v.wx + gained_x, v.wy + gained_y, v.wz + gained_z
                    return free_turn(body, v, rest) and solved
                return True
        x, y, z = v.vx * dt, v.vy * dt, v.vz * dt
        sprung = False
        if springs:
            # Where contacts were looked at and none pushes, v is at a middle that they found.
            sprung = body.sprung > 0 and m.carried == 0
            if turns and sprung:
                v.wx, v.wy, v.wz = body.to_wx, body.to_wy, body.to_wz
        if centred and not sprung:
            lasting = m.carried == LASTING
            if lasting:
                half = 0.5 * dt
                x, y, z = half * (m.vx + v.vx), half * (m.vy + v.vy), half * (m.vz + v.vz)
            if turns and (lasting or m.midway == MIDDLE):
                body.x, body.y, body.z = body.x + x, body.y + y, body.z + z
                even = True
                if uneven:
                    even = is_round(body)
                if exactly and even and lasting:
                    if body.inv_m == 0.0 or body.shape == SPHERE:
                        x, y, z = m.wx + v.wx, m.wy + v.wy, m.wz + v.wz
                        turn_exactly(body, half * x, half * y, half * z)
                        return True
                if even and lasting:
                    turn(body, half * (m.wx + v.wx), half * (m.wy + v.wy), half * (m.wz + v.wz))
                    return True
                if even:
                    return free_turn(body, v, dt)
                if m.midway != MIDDLE:  # its contacts are those of the start
                    # All but still; what was to turn may win energy by a half behind its turn.
                    if lasting and m.midway != UNFOUND:
                        return turn_in_halves(body, v, m, dt)
                    return free_turn(body, v, dt)
                # Impulses changed its spin at the middle; what jumps turns with that after them.
                mean = Vec3(m.mean_x, m.mean_y, m.mean_z)
                end = Vec3(v.wx, v.wy, v.wz)
                v.wx, v.wy, v.wz = m.wx, m.wy, m.wz
                kind = JUMPS
                if lasting:
                    kind = RESTRAINED if m.restrained == 1 else GIVES
                turn_by_mean(body, v, mean, end, kind, dt)
                return True
        if springs:
            if sprung and body.sprung == PLACED:
                body.x += body.shift_x
                body.y += body.shift_y
                body.z += body.shift_z
                if turns:
                    turn(body, dt * body.turn_x, dt * body.turn_y, dt * body.turn_z)
                return True
            if uneven:
                if sprung and not is_round(body):
                    half = 0.5 * dt
                    body.x += half * (m.vx + v.vx)
                    body.y += half * (m.vy + v.vy)
                    body.z += half * (m.vz + v.vz)
                    twist(body, v, dt)
                    return True
        if midpoint:
            if m.carried == 0:
                half = 0.5 * dt
                x, y, z = x - half * m.dvx, y - half * m.dvy, z - half * m.dvz
        body.x, body.y, body.z = body.x + x, body.y + y, body.z + z
        if twists:
            if m.carried == 0:
                return turn_in_halves(body, v, m, dt)
        if turns:
            return free_turn(body, v, dt)
        return True

    return kernel(displace, spec)


def make_integrate(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, motion, pseudo, moved, dt) -> (diverged or -1, cause)`."""
    turns, projects = step_terms(spec).turns, has_hook(spec, "project")
    torque = row_terms(spec).levers
    kinematic = step_terms(spec).kinematic
    keeps = keeps_motion(spec)
    integrate_rotation: Any = make_turn(spec)
    displace: Any = make_displace(spec) if keeps else None

    def integrate(bodies, velocities, motion, pseudo, moved, dt):
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            moves = body.inv_m > 0.0
            if kinematic:
                moves = moves or body.kinematic == 1
            if moves:
                solved = True
                if keeps:
                    solved = displace(body, v, motion[i], dt)
                else:
                    body.x += v.vx * dt
                    body.y += v.vy * dt
                    body.z += v.vz * dt
                    if turns:
                        solved = integrate_rotation(body, v, dt)
                if projects:
                    if moved:
                        u = pseudo[i]
                        body.x, body.y, body.z = body.x + u.vx, body.y + u.vy, body.z + u.vz
                        if torque:
                            turn(body, u.wx, u.wy, u.wz)
                # x - x is 0 for finite numbers only; one sum tests them all. Speeds enter squared:
                # one whose square overflows has no energy, and would turn a quaternion into zero.
                total = body.x + body.y + body.z + v.vx * v.vx + v.vy * v.vy + v.vz * v.vz
                if turns:
                    total += body.qw + v.wx * v.wx + v.wy * v.wy + v.wz * v.wz
                if total - total != 0.0:
                    return i, NOT_FINITE
                if not solved:
                    return i, TURNS_TOO_FAST
        return -1, NOT_FINITE

    return kernel(integrate, spec)
