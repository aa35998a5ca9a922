"""What the contacts of a step do to velocities: complete the rows, solve them, log them.

append       each contact: frame, effective mass, what is captured once
warm start   impulses of contacts that persist
solve        velocities, and where impacts gained energy, once more
log          the trace rows of contacts
classify     how bodies move through the step: free, carried or in an impact
project      pseudo-velocities that move poses out of what still penetrates
"""

from __future__ import annotations

from typing import Any

from . import ordering
from .compile import chain, kernel, separate
from .contact import make_append_contact, make_apply_start
from .contact_spring_law import make_solve_by_tangents
from .effects import has_hook, made_by, made_once
from .integrate import keeps_motion, make_classify
from .joint_turn import make_joint_velocity
from .midpoint_passes import make_midpoint_passes, make_stand_up
from .midpoint_rows import (
    is_free,
    make_is_moving,
    make_lasting,
    make_note_restrained,
    make_note_unparted,
)
from .overlooked_points import make_look_over
from .records import INSTANT
from .row_terms import make_acts, row_terms
from .solvers.catalogue import SOLVERS
from .solvers.solver import ContactSystem
from .spec import Spec
from .step_terms import step_terms
from .stiff_springs import may_rebound

# Rows that are worked out before the next ones: some 200 KB, a part of a core's own cache.
NEAR = 256


def make_solve(spec: Spec) -> Any:
    """Return the solver's kernel, with impulses chosen where the laws leave them open."""
    linear = _make_solve_and_choose(spec)
    return make_solve_by_tangents(spec, linear) if row_terms(spec).elastic else linear


def _make_solve_and_choose(spec: Spec) -> Any:
    solve = SOLVERS[spec.solver].make(spec)
    chooses, choose_impulses = made_once(spec, "choose_impulses")
    if not chooses:
        return separate(solve, spec)

    def solve_and_choose(system, workspace, params, counters, residual_rows):
        solve(system, workspace, params, counters, residual_rows)
        if counters.not_converged == 0 and system.count > 1:
            choose_impulses(system, workspace, params, counters)

    return separate(kernel(solve_and_choose, spec), spec)


def make_respond(spec: Spec, log_contacts: Any) -> Any:
    """Return `kernel(state, count, workspace, params, counters, log) -> length`, see `memory`.

    length: 0; or the part, which may be no longer [s], is to be made again, with points of pairs
    that are now `whole` (`overlooked_points`). log_contacts: the kernel of `contact_log`.
    """
    append_contact = make_append_contact(spec, chain(made_by(spec, "capture"), spec))
    order_contacts = ordering.make(spec)
    shuffles = spec.order == "random"
    shuffle: Any = ordering.make_shuffle(spec) if shuffles else None
    solve = make_solve(spec)
    predicts, predict_impacts = made_once(spec, "predict_impacts")
    _, foresee_impacts = made_once(spec, "foresee_impacts")
    reverses, reverse_slip = made_once(spec, "reverse_slip")
    reverses = reverses and predicts  # idle where no law of impacts is beside it
    warms, match_contacts = made_once(spec, "match")
    _, store_contacts = made_once(spec, "store")
    yields, recall_stretch = made_once(spec, "recall_stretch")
    _, keep_stretch = made_once(spec, "keep_stretch")
    apply_start: Any = make_apply_start(spec) if warms else None
    acts = make_acts(spec)
    watched, note = made_once(spec, "note_slip")
    keeps = keeps_motion(spec)
    classify: Any = make_classify(spec) if watched or keeps else None
    _, settle = made_once(spec, "limit_impacts", solve, classify)
    projects, project_positions = made_once(spec, "project")
    stores, contact_energy = made_once(spec, "contact_energy")
    logs = has_hook(spec, "log_contacts")
    keeps_free, keep_free = made_once(spec, "keep_free")
    loads = made_by(spec, "preload")
    loaded = bool(loads)
    preload: Any = chain(loads, spec) if loaded else None

    ordered, centred = step_terms(spec).ordered_impacts, step_terms(spec).centred
    rebounds = ordered and may_rebound(spec)
    lasting: Any = make_lasting(spec) if centred else None
    note_restrained: Any = make_note_restrained(spec) if centred else None
    is_moving: Any = make_is_moving(spec) if centred else None
    bilateral = row_terms(spec).bilateral
    joint_velocity: Any = make_joint_velocity(spec) if bilateral else None
    joined = bilateral and centred
    note_unparted: Any = make_note_unparted(spec) if joined else None
    midpoint_passes: Any = None
    if centred:
        midpoint_passes = make_midpoint_passes(spec, append_contact, preload, solve)
    stand_up: Any = make_stand_up(spec) if centred else None
    overlooks = step_terms(spec).overlooks
    look_over: Any = make_look_over(spec) if overlooks else None

    beside = centred and has_hook(spec, "act_beside")

    def solve_part(state, count, workspace, params, counters, log):
        # From velocities without impulses of contacts; whether bodies then stand at the middle.
        bodies, velocities, motion = state.bodies, state.velocities, state.motion
        lasts = True  # an impulse of an instant is no guess for a force
        if ordered:
            lasts = params.dt > INSTANT
        contacts, cache, pairs = state.contacts, state.cache, state.pairs
        order = workspace.ordering.order
        if yields:
            recall_stretch(contacts, count, bodies, cache, counters, params)
        predicted = predicts
        if ordered:
            # Motion between impacts has none, unless they are left without order.
            predicted = not lasts or counters.unordered == 1
            if beside:
                predicted = predicted and workspace.beside.impacts[0] == 1
        # What is worked out of a row by itself is so while the row is near: of a scene larger than
        # the caches rows come from memory once. Impacts are predicted from all of them, and what
        # slips back is asked of their targets.
        meets = False
        if predicts:
            if predicted:
                for i in range(motion.shape[0]):
                    motion[i].tau = params.dt
        moves = False  # at rest each body's friction acts at its own surface
        if centred:
            moves = is_moving(bodies, motion)
            if moves:
                note_restrained(contacts, count, pairs, bodies, motion, params.slop)
        begin, together = 0, NEAR
        if reverses:
            if predicted:
                together = count
        while begin < count:
            end = min(begin + together, count)
            for c in range(begin, end):
                contact, pair = contacts[c], pairs[contacts[c].pair]
                if centred:
                    contact.lasts = 0
                    if moves and contact.phi <= params.slop:
                        contact.lasts = is_free(contact, motion)
                append_contact(contact, bodies, velocities, motion, pair, params)
            if watched:
                for c in range(begin, end):
                    contact = contacts[c]
                    note(contact, velocities[contact.a], velocities[contact.b])
            if ordered:
                if not predicted:
                    for c in range(begin, end):
                        contacts[c].is_impact, contacts[c].tau = 0, params.dt
            if rebounds:
                if counters.plastic == 1:
                    for c in range(begin, end):
                        contacts[c].e = 0.0
            if predicts:
                if predicted:
                    if foresee_impacts(contacts, begin, end, count, motion, params):
                        meets = True
                    if reverses:
                        if meets:
                            predict_impacts(contacts, count, motion, params)
            if reverses:
                for c in range(begin, end):
                    contact = contacts[c]
                    va, vb = velocities[contact.a], velocities[contact.b]
                    reverse_slip(contact, pairs[contact.pair], va, vb)
            if centred:
                for c in range(begin, end):
                    lasting(contacts[c], pairs[contacts[c].pair], velocities, motion, params)
                if bilateral:
                    for c in range(begin, end):
                        contact = contacts[c]
                        if contact.bilateral == 1:
                            ma, mb = motion[contact.a], motion[contact.b]
                            parting = joint_velocity(contact, ma, mb)
                            contact.parting_x, contact.parting_y = parting.x, parting.y
                            contact.parting_z = parting.z
            begin = end
        if predicts and not reverses:
            if meets:
                predict_impacts(contacts, count, motion, params)
        if centred:
            moving = lasts and moves
            if moving:
                for i in range(velocities.shape[0]):
                    workspace.middle.free[i] = velocities[i]
        if loaded:
            for c in range(count):
                preload(contacts[c], velocities, motion)
        if keeps_free:
            keep_free(velocities, workspace.free_velocities)
        if warms and lasts:
            match_contacts(contacts, count, bodies, cache, counters, params)
            for c in range(count):
                contact = contacts[c]
                if acts(contact):
                    va, vb = velocities[contact.a], velocities[contact.b]
                    apply_start(contact, va, vb)
        order_contacts(bodies, contacts, count, workspace.ordering)
        if shuffles:
            shuffle(order, count, counters.step)
        system = ContactSystem(contacts, order, count, bodies, velocities)
        solve(system, workspace.solver, params, counters, log.residual)
        if watched:
            settle(system, motion, workspace.solver, params, counters, log.residual)
        midway = False
        if centred:
            if beside:
                moving = moving and workspace.beside.passes[0] == 1
            if moving:
                midway = midpoint_passes(state, count, workspace, params, counters, log)
            if joined:
                if lasts:
                    note_unparted(motion, midway)
        return midway

    solve_part = kernel(solve_part, spec)
    act_beside: Any = None
    limit_projection: Any = None
    if beside:
        _, act_beside = made_once(spec, "act_beside", solve_part)
        _, limit_projection = made_once(spec, "limit_projection")

    def respond(state, count, workspace, params, counters, log):
        bodies, velocities, motion = state.bodies, state.velocities, state.motion
        contacts, cache = state.contacts, state.cache
        lasts = True
        if ordered:
            lasts = params.dt > INSTANT
        if overlooks:
            unfound = counters.midpoint_not_converged
            unturned = counters.gyroscopic_not_converged
        if beside:
            springs = workspace.beside
            springs.before[0] = counters.midpoint_not_converged
            springs.before[1] = counters.gyroscopic_not_converged
            springs.passes[0], springs.impacts[0] = 1, 1
        midway = solve_part(state, count, workspace, params, counters, log)
        if beside:
            if lasts:
                springs.midway[0] = 1 if midway else 0
                midway = act_beside(state, count, workspace, params, counters, log)
        if overlooks:
            if lasts and workspace.overlooked.noted[0] > 0:
                if keeps:
                    classify(contacts, count, motion, params)
                poses = workspace.middle.poses if midway else bodies
                cut = look_over(state, poses, workspace.overlooked, params)
                if cut > 0.0:  # what is made again has not been
                    counters.midpoint_not_converged = unfound
                    counters.gyroscopic_not_converged = unturned
                    if centred:
                        if midway:
                            stand_up(bodies, poses)
                    return cut
        if yields and lasts:
            keep_stretch(contacts, count, velocities, motion, params)
        if stores and lasts:
            counters.contact_energy = contact_energy(contacts, count, velocities, params)
        if logs:
            log_contacts(contacts, count, velocities, params, counters, log)
        if warms and lasts:
            store_contacts(contacts, count, bodies, cache, counters, params)
        if keeps:
            classify(contacts, count, motion, params)
        counters.projection_sweeps = 0
        if projects and lasts:
            system = ContactSystem(contacts, workspace.ordering.order, count, bodies, velocities)
            counters.projection_sweeps = project_positions(
                system, motion, state.pseudo, workspace.solver, params
            )
            if beside:
                if counters.projection_sweeps > 0 and state.links.shape[0] > 0:
                    if midway:
                        stand_up(bodies, workspace.middle.poses)
                        midway = False
                    limit_projection(state, workspace, params)
        if centred:
            if midway:
                stand_up(bodies, workspace.middle.poses)
        return 0.0

    return separate(kernel(respond, spec), spec)


def make_pass_by(spec: Spec, log_contacts: Any) -> Any:
    """Return `kernel(contacts, velocities, motion, params, counters, log)`: for no contact."""
    logs, keeps = has_hook(spec, "log_contacts"), keeps_motion(spec)
    stores, contact_energy = made_once(spec, "contact_energy")
    classify: Any = make_classify(spec) if keeps else None

    def pass_by(contacts, velocities, motion, params, counters, log):
        counters.sweeps, counters.projection_sweeps = 0, 0
        counters.residual, counters.residual_contact = 0.0, -1
        counters.not_converged, counters.stronge, counters.sharpen = 0, 0, 0
        counters.cached, counters.contact_energy = 0, 0.0
        if stores:
            counters.contact_energy = contact_energy(contacts, 0, velocities, params)
        if logs:
            log_contacts(contacts, 0, velocities, params, counters, log)
        if keeps:
            classify(contacts, 0, motion, params)

    return kernel(pass_by, spec)
