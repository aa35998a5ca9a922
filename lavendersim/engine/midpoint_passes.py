"""Contacts at the middle of the step, solved by fixed-point passes (`effects.contact_midpoint`).

The middle is where the velocities of the last solve lead: a fixed point, found in a few passes,
each with its own rows and solve. A step in which nothing turns is done after the first, at its
start.
"""

from __future__ import annotations

from math import inf
from typing import Any

from .compile import either, greatest, kernel
from .contact import make_apply_start
from .contact_spring_law import make_linearise
from .effects import has_hook, made_by, made_once
from .free_flight import make_widen
from .integrate import MIDDLE, UNFOUND
from .midpoint_geometry import (
    make_keep_start,
    make_look,
    make_stand_midway,
    make_stay,
    make_take_kept,
)
from .midpoint_impulses import make_go_on, make_impulse_of
from .midpoint_jumps import make_carry_along
from .midpoint_mixing import NO_PASS, make_mix_velocities
from .midpoint_rows import (
    SAME,
    is_free,
    make_begin_slip,
    make_lasting,
    make_resist,
    make_shift,
)
from .midpoint_turning import make_is_turning
from .parts import make_forget_history
from .residual import make_residual
from .rotation import inertia_times, inverse_inertia_times, is_round
from .row_terms import make_acts, row_terms
from .solvers.solver import ContactSystem
from .spec import Spec
from .step_terms import step_terms

# Each pass gains some two digits where bodies turn by a tenth of a radian in a step.
PASSES = 8
# More are made, up to so many, of solves that converge, as long as one of IDLE brings the least
# that was missed down to the share GAIN [-].
MOST_PASSES, IDLE, GAIN = 32, 4, 0.9
# From this one on a contact that still comes and goes is none of the middle (`midpoint_jumps`).
SETTLED = 3


def make_midpoint_passes(spec: Spec, append_contact: Any, preload: Any, solve: Any) -> Any:
    """Return `kernel(state, count, workspace, params, counters, log) -> whether it passed`.

    After a solve at the start of the step. Bodies then stand at the middle: see `make_stand_up`.
    append_contact, preload: kernels of `respond`; preload: None where nothing is preloaded.
    """
    friction, turns = row_terms(spec).frictional, step_terms(spec).turns
    bilateral, acts = row_terms(spec).bilateral, make_acts(spec)
    uneven = has_hook(spec, "turn_uneven")
    is_turning, begin_slip = make_is_turning(spec), make_begin_slip(spec)
    lasting, resist = make_lasting(spec), make_resist(spec)
    keep_start, stay = make_keep_start(spec), make_stay(spec)
    stand_midway, look, shift = make_stand_midway(spec), make_look(spec), make_shift(spec)
    widen, carry_along = make_widen(spec), make_carry_along(spec)
    carries_inertia, refresh_inertia = made_once(spec, "refresh_inertia")
    impulse_of, go_on = make_impulse_of(spec), make_go_on(spec)
    apply_start, take_kept = make_apply_start(spec), make_take_kept(spec)
    keeps_free, keep_free = made_once(spec, "keep_free")
    at_surface, loaded = step_terms(spec).timed_impacts, preload is not None
    forget_history = make_forget_history(spec)
    residual, mix_velocities = make_residual(spec), make_mix_velocities(spec)
    beside = has_hook(spec, "act_beside")
    differing, noting = made_by(spec, "differs_midway"), made_by(spec, "note_middle")
    differs, notes = bool(differing), bool(noting)
    differs_midway: Any = either(differing, spec) if differs else None
    note_middle: Any = greatest(noting, spec) if notes else None
    acts_midway, act_midway = made_once(spec, "act_midway")
    springs = row_terms(spec).elastic
    linearise: Any = make_linearise(spec) if springs else None

    def has_impact(contacts, count):
        found = False
        for c in range(count):
            found = found or contacts[c].is_impact == 1
        return found

    has_impact = kernel(has_impact, spec)

    def note_unfound(contacts, count, motion):
        for c in range(count):
            contact = contacts[c]
            if acts(contact):
                motion[contact.a].midway, motion[contact.b].midway = UNFOUND, UNFOUND

    note_unfound = kernel(note_unfound, spec)

    def restore(velocities, free, lead, motion):
        for i in range(velocities.shape[0]):
            v, before = velocities[i], free[i]
            v.vx, v.vy, v.vz = before.vx, before.vy, before.vz
            if turns:
                # What forces added to the spin of the start, they add to that of the middle.
                spin, m = lead[i], motion[i]
                v.wx = before.wx + (spin.wx - m.wx)
                v.wy = before.wy + (spin.wy - m.wy)
                v.wz = before.wz + (spin.wz - m.wz)

    restore = kernel(restore, spec)

    def forget(free, motion):
        # What contacts draw by themselves is noted anew with each row (`preload`), once.
        for i in range(free.shape[0]):
            before, m = free[i], motion[i]
            m.dvx, m.dvy, m.dvz = before.vx - m.vx, before.vy - m.vy, before.vz - m.vz

    twists = beside and turns

    def twist(bodies, poses, velocities):
        # What springs add to the spin of the middle is their impulse by the inertia there.
        for i in range(bodies.shape[0]):
            body, start, v = bodies[i], poses[i], velocities[i]
            if start.sprung > 0 and not is_round(start):
                x, y, z = start.to_wx, start.to_wy, start.to_wz
                x, y, z = x - start.spun_x, y - start.spun_y, z - start.spun_z
                lx, ly, lz = inertia_times(start, x, y, z)
                lx, ly, lz = inverse_inertia_times(body, lx, ly, lz)
                v.wx, v.wy, v.wz = v.wx + (lx - x), v.wy + (ly - y), v.wz + (lz - z)

    twist_midway: Any = kernel(twist, spec) if twists else None

    def note(bodies, velocities):
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            body.solved_x, body.solved_y, body.solved_z = v.wx, v.wy, v.wz

    note_solved: Any = kernel(note, spec) if twists else None

    forget_load: Any = kernel(forget, spec) if loaded else None

    def midpoint_passes(state, count, workspace, params, counters, log):
        bodies, velocities, motion = state.bodies, state.velocities, state.motion
        contacts, pairs = state.contacts, state.pairs
        poses, free, lead, rounds = workspace.middle
        for i in range(motion.shape[0]):
            motion[i].midway = 0
        if counters.not_converged == 1:
            note_unfound(contacts, count, motion)
            return False
        if at_surface:
            if has_impact(contacts, count):
                return False
        slip_turns = False
        if friction:
            slip_turns = begin_slip(contacts, count, velocities, motion)
        changes = slip_turns or is_turning(contacts, count, bodies, motion, params)
        if differs:
            changes = changes or differs_midway(state, count, params)
        if not changes:
            return False
        for i in range(bodies.shape[0]):
            poses[i] = bodies[i]
            if turns:
                spin, m = lead[i], motion[i]
                spin.wx, spin.wy, spin.wz = m.wx, m.wy, m.wz
        keep_start(contacts, count)
        sweeps = counters.sweeps
        order = workspace.ordering.order
        system = ContactSystem(contacts, order, count, bodies, velocities)
        missed, unturned, torn = 0.0, 0, False
        least, idle, columns = inf, 0, NO_PASS
        for k in range(MOST_PASSES):
            columns = mix_velocities(bodies, velocities, rounds, columns)
            unturned = stand_midway(bodies, velocities, motion, lead, poses, params.dt)
            look(state, count, poses, workspace)
            changed = 0.0
            if notes:
                changed = note_middle(bodies, velocities, lead, True, params)
            restore(velocities, free, lead, motion)
            if acts_midway:
                act_midway(bodies, poses, velocities)
            if twists:
                twist_midway(bodies, poses, velocities)
                note_solved(bodies, velocities)
            if loaded:
                forget_load(free, motion)
            if carries_inertia:
                refresh_inertia(bodies, velocities)
            for c in range(count):
                contact = contacts[c]
                impulse = impulse_of(contact)
                contact.lasts = is_free(contact, motion)
                append_contact(contact, bodies, velocities, motion, pairs[contact.pair], params)
                shift(contact, pairs[contact.pair], lead, motion, params)
                if contact.jumps == 1:
                    contact.lasts = 0
                if contact.lasts == 0:  # it has no middle: what is met there may be elsewhere
                    stay(contact, bodies, poses)
                    append_contact(contact, bodies, velocities, motion, pairs[contact.pair], params)
                    widen(contact, params)
                go_on(contact, impulse)
            if loaded:
                for c in range(count):
                    preload(contacts[c], velocities, motion)
            if keeps_free:
                keep_free(velocities, workspace.free_velocities)
            for c in range(count):
                contact = contacts[c]
                if acts(contact):
                    apply_start(contact, velocities[contact.a], velocities[contact.b])
            if springs:
                linearise(contacts, count, velocities, params)
            missed, _ = residual(contacts, count, velocities)
            if notes:
                missed = max(missed, changed)
            forget_history(counters, log.residual)
            solve(system, workspace.solver, params, counters, log.residual)
            sweeps += counters.sweeps
            torn = False
            if missed <= SAME or k >= SETTLED:
                torn = carry_along(contacts, count, motion)
            if friction:
                if missed <= SAME:
                    torn = resist(contacts, count, velocities) or torn
            if missed <= SAME and not torn:
                break
            idle += 1
            if missed < GAIN * least:
                least, idle = missed, 0
            if k >= PASSES - 1 and (idle >= IDLE or counters.not_converged == 1):
                break
        # A pass may miss what solves leave.
        left = not missed <= max(SAME, params.tolerance)
        if counters.not_converged == 1 or torn or left:
            counters.midpoint_not_converged += 1
        if uneven:
            counters.gyroscopic_not_converged += unturned
        if counters.not_converged == 1 or torn or left:
            # What is solved at the start is better than what is not solved at the middle, or at no
            # middle: where passes end without one hangs on the last bit, and may give energy.
            for i in range(bodies.shape[0]):
                bodies[i], velocities[i] = poses[i], free[i]
            if loaded:
                forget_load(free, motion)
            if carries_inertia:
                refresh_inertia(bodies, velocities)
            for c in range(count):
                contact = contacts[c]
                stay(contact, bodies, poses)
                contact.lasts = is_free(contact, motion) if contact.phi <= params.slop else 0
                append_contact(contact, bodies, velocities, motion, pairs[contact.pair], params)
                lasting(contact, pairs[contact.pair], velocities, motion, params)
            if loaded:
                for c in range(count):
                    preload(contacts[c], velocities, motion)
            for c in range(count):
                contact = contacts[c]
                kept = contact.kept_n > 0.0
                if bilateral:
                    kept = kept or contact.bilateral == 1
                if kept:
                    take_kept(contact)
                    apply_start(contact, velocities[contact.a], velocities[contact.b])
            forget_history(counters, log.residual)
            solve(system, workspace.solver, params, counters, log.residual)
            counters.sweeps += sweeps
            note_unfound(contacts, count, motion)
            return False
        counters.sweeps = sweeps
        if notes:
            note_middle(bodies, velocities, lead, False, params)
        for c in range(count):
            contact = contacts[c]
            if acts(contact):
                motion[contact.a].midway, motion[contact.b].midway = MIDDLE, MIDDLE
        for i in range(motion.shape[0]):
            if motion[i].midway == 0:  # it flies, from the start of the step
                v, before = velocities[i], free[i]
                if loaded:  # by what draws it: `restore` gave it the spin of the middle
                    if turns:
                        spin, m = lead[i], motion[i]
                        v.wx -= spin.wx - m.wx
                        v.wy -= spin.wy - m.wy
                        v.wz -= spin.wz - m.wz
                else:
                    v.vx, v.vy, v.vz = before.vx, before.vy, before.vz
                    if turns:
                        v.wx, v.wy, v.wz = before.wx, before.wy, before.wz
            elif turns:
                v, spin, m = velocities[i], lead[i], motion[i]
                m.mean_x = 0.5 * (spin.wx + v.wx)
                m.mean_y = 0.5 * (spin.wy + v.wy)
                m.mean_z = 0.5 * (spin.wz + v.wz)
        return True

    return kernel(midpoint_passes, spec)


def make_stand_up(spec: Spec) -> Any:
    """Return `kernel(bodies, poses)`: bodies stand again where the step began."""

    def stand_up(bodies, poses):
        for i in range(bodies.shape[0]):
            bodies[i] = poses[i]

    return kernel(stand_up, spec)


def make_go_back(spec: Spec) -> Any:
    """Return `kernel(state, count, poses)`: as `stand_up`, and contacts where they were there."""
    stand_up, stay = make_stand_up(spec), make_stay(spec)

    def go_back(state, count, poses):
        bodies, contacts = state.bodies, state.contacts
        stand_up(bodies, poses)
        for c in range(count):
            stay(contacts[c], bodies, poses)

    return kernel(go_back, spec)
