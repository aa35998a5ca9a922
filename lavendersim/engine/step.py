"""The step on one screen: forces and contacts change velocities, then poses move (`make_advance`).

drive        what is a function of time: the forces of the step, the motion of kinematic bodies
accelerate   v += dt * forces; before contacts are looked for where the rest of the step needs the
             velocities before and after (`integrate.keeps_motion`), else once they are found
collide      contacts at the pose the step begins with, and those the step may make
respond      velocities that respect every contact (`respond`)
order        what part of the step comes next: an impact, or motion up to the next (`impact_order`)
integrate    poses by semi-implicit Euler, the midpoint rule, or flight up to an impact and on from
             it (`integrate`); and out of what still penetrates, without velocity
log          the trace row of the step
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Any

from lavendersim.garbage import uncollected

from .approach import NEVER, make_note_acceleration
from .collide import narrow_phase
from .collide.iteration_limits import has_limits
from .collide.limit_counts import forget_limits, make_count_limits
from .compile import chain, kernel, naming
from .effects import BY_NAME, has_hook, made_by, made_once
from .integrate import (
    keeps_motion,
    make_begin,
    make_finish,
    make_integrate,
    make_stand,
    make_undo,
)
from .kernel_cache import cached
from .kernel_store import kernels_on_disk
from .motor_reach import make_note_drive, reaches_speeds
from .overlooked_points import make_forget_whole
from .parts import has_parts, make_end_step, make_forget_history, make_gather_parts
from .records import (
    CONTACTS_FULL,
    DIVERGED,
    INACCURATE,
    INSTANT,
    PAIRS_FULL,
    ROWS_FULL,
    RUNNING,
    WOKEN,
)
from .reset_counts import make_reset_counts
from .respond import make_pass_by, make_respond
from .spec import Spec
from .step_doubling import (
    GO_ON,
    MISSED,
    NOTHING,
    make_abandon,
    make_begin_substep,
    make_end_span,
    make_note_part,
)
from .step_terms import step_terms


def make_advance(spec: Spec) -> Any:
    """Compose `advance(state, workspace, log, parameters, counters, steps) -> status` (`memory`).

    parameters, counters: records of shape (1,); the latter say how many steps are done.
    """
    touches, record_residuals = spec.touches, has_hook(spec, "sweep_row")
    # The row of a step hashes the poses, whether or not they are logged.
    make_log_pose: Any = BY_NAME["pose_log"].hooks.log_pose
    log_pose = make_log_pose(spec) if has_hook(spec, "log_step") else None
    records, log_step = made_once(spec, "log_step", log_pose, made_by(spec, "step_row"))
    accelerations = made_by(spec, "accelerate")
    accelerates, keeps = bool(accelerations), keeps_motion(spec)
    accelerate = chain(accelerations, spec)
    begin: Any = make_begin(spec, accelerate) if keeps else None
    undo: Any = make_undo(spec) if keeps else None
    carries_inertia, refresh_inertia = made_once(spec, "refresh_inertia")
    compound, place_parts = made_once(spec, "place_parts")
    broad, find_pairs = made_once(spec, "find_pairs")
    collide: Any = narrow_phase.make(spec) if touches else None
    _, log_contacts = made_once(spec, "log_contacts", made_by(spec, "contact_row"))
    respond: Any = make_respond(spec, log_contacts) if touches else None
    # With residuals recorded a step without contacts has its history, too.
    passes = touches and not record_residuals
    pass_by: Any = make_pass_by(spec, log_contacts) if passes else None
    integrate = make_integrate(spec)
    linked, act_between = made_once(spec, "act_between")
    _, log_links = made_once(spec, "link_row")
    finish: Any = make_finish(spec) if linked and keeps else None
    driving = made_by(spec, "drive")
    driven = bool(driving)
    drive: Any = chain(driving, spec) if driven else None
    ending = made_by(spec, "end_part")
    ends = bool(ending)
    end_part: Any = chain(ending, spec) if ends else None
    starting = made_by(spec, "start_step")
    starts = bool(starting)
    start_step: Any = chain(starting, spec) if starts else None
    ordered, order = made_once(spec, "order_impacts")
    note_acceleration: Any = make_note_acceleration(spec) if ordered else None
    reaches = reaches_speeds(spec)
    note_drive: Any = make_note_drive(spec) if reaches else None
    controlled = step_terms(spec).substeps
    in_parts = has_parts(spec)
    gather: Any = make_gather_parts(spec) if in_parts else None
    forget_history: Any = make_forget_history(spec) if in_parts else None
    end_step: Any = make_end_step(spec) if in_parts else None
    begin_substep: Any = make_begin_substep(spec) if controlled else None
    end_span: Any = make_end_span(spec) if controlled else None
    abandon: Any = make_abandon(spec) if controlled else None
    note_part: Any = make_note_part(spec) if controlled and ordered else None
    stand: Any = make_stand(spec) if ordered else None
    iterates = touches and has_limits(spec)
    count_limits: Any = make_count_limits(spec) if iterates else None
    reset_counts = make_reset_counts(spec)
    triggered, meet_triggers = made_once(spec, "meet_triggers")
    overlooks = step_terms(spec).overlooks
    forget_whole: Any = make_forget_whole(spec) if overlooks else None
    sleeps, measure_speeds = made_once(spec, "measure_speeds")
    _, wake = made_once(spec, "wake")
    _, update_sleeping = made_once(spec, "update_sleeping")

    def advance(state, workspace, log, parameters, counter, steps):
        bodies, velocities, pairs = state.bodies, state.velocities, state.pairs
        contacts, motion = state.contacts, state.motion
        params, counters = parameters[0], counter[0]
        if records:
            if counters.started == 0:
                if linked:
                    log_links(log.step[counters.step_rows], state.links, bodies)
                if triggered:
                    meet_triggers(state, log, counters)
                log_step(bodies, velocities, params, counters, log)
        counters.started = 1
        if touches:
            pull = workspace.collision.outline_a.pull
            pull[0], pull[1], pull[2] = params.gx, params.gy, params.gz
        done, listed, again, longest = 0, 0, False, NEVER
        if overlooks:
            unmade = workspace.overlooked.unmade[0]
            if unmade.again == 1:
                listed, again, longest = unmade.listed, True, unmade.longest
                unmade.again = 0
        while done < steps:
            begins = True
            if in_parts:
                begins = counters.parts == 0
            if begins:
                params.timestep = params.dt
                reset_counts(counters)
            if ordered and not controlled:
                params.dt = params.timestep - counters.elapsed
            if begins:
                if records:
                    if counters.step_rows == log.step.shape[0]:
                        return ROWS_FULL
            if controlled:
                control = state.control.record[0]
                if control.phase == NOTHING:
                    begin_substep(state, params, counters, log.step)
                params.dt = control.until - counters.elapsed
            if record_residuals:
                if in_parts:
                    forget_history(counters, log.residual)
                if counters.residual_rows + params.sweeps + 1 > log.residual.shape[0]:
                    if controlled:
                        abandon(state, params, counter, log.step)
                    params.dt = params.timestep
                    return ROWS_FULL
            if driven:
                drive(state.drives, bodies, velocities, params, counters)
            if sleeps:
                if begins:
                    measure_speeds(bodies, velocities)
            if starts:
                start_step(bodies, velocities)
            if keeps:
                begin(bodies, velocities, motion, params)
                if linked:
                    unfound = counters.spring_not_converged
                    act_between(state.links, bodies, velocities, motion, params, counters)
                    finish(bodies, velocities, motion, params)
            if carries_inertia:
                refresh_inertia(bodies, velocities)
            if compound:
                place_parts(bodies)
            looks = True  # for pairs: a part that is made again has those of its first time
            if overlooks:
                looks = not again
            if looks:
                listed = pairs.shape[0]
                if broad:
                    broad_phase = workspace.broad_phase
                    listed = find_pairs(
                        bodies, velocities, pairs, workspace.templates, params, broad_phase
                    )
            count = 0
            if touches:
                if listed >= 0:
                    count = collide(state, listed, workspace, params.dt)
            full = RUNNING
            if listed < 0:
                full = PAIRS_FULL
            elif count < 0:
                full = CONTACTS_FULL
            if records:
                rows = counters.contact_rows + count
                if in_parts:
                    if not begins:
                        rows += log.step[counters.step_rows].contact_count
                if full == RUNNING and rows > log.contact.shape[0]:
                    full = ROWS_FULL
            if sleeps:
                if full == RUNNING and wake(bodies, contacts, count, params):
                    full = WOKEN
            if full != RUNNING:
                if iterates:
                    forget_limits(workspace.collision)
                if keeps:
                    undo(velocities, motion)
                    if linked:
                        counters.spring_not_converged = unfound
                if overlooks:
                    if again:
                        if controlled or full == WOKEN:
                            forget_whole(pairs, listed)
                        else:  # till there is room
                            unmade.again, unmade.listed, unmade.longest = 1, listed, longest
                if controlled:
                    abandon(state, params, counter, log.step)
                params.dt = params.timestep
                return full
            instant = False
            if ordered:
                left = length = params.dt
                if count > 0:
                    count, length = order(state, count, workspace, params, counters)
                instant = length == 0.0
                if overlooks:
                    length = min(length, longest)
                if length < left:
                    undo(velocities, motion)
                    params.dt = max(length, INSTANT)
                if instant:
                    stand(velocities, motion)
                elif length < left:
                    if driven:
                        drive(state.drives, bodies, velocities, params, counters)
                    begin(bodies, velocities, motion, params)
                    if linked:
                        act_between(state.links, bodies, velocities, motion, params, counters)
                        finish(bodies, velocities, motion, params)
            if accelerates and not keeps:
                for i in range(bodies.shape[0]):
                    if bodies[i].inv_m > 0.0:
                        accelerate(bodies[i], velocities[i], params)
            if linked and not keeps:
                act_between(state.links, bodies, velocities, motion, params, counters)
            if touches:
                passed = False
                if passes:
                    if count == 0:
                        pass_by(contacts, velocities, motion, params, counters, log)
                        passed = True
                if not passed:
                    cut = respond(state, count, workspace, params, counters, log)
                    if overlooks:
                        if cut > 0.0:
                            undo(velocities, motion)
                            if linked and keeps:
                                counters.spring_not_converged = unfound
                            if iterates:
                                forget_limits(workspace.collision)
                            params.dt, longest, again = params.timestep, cut, True
                            continue
                if overlooks:
                    if again:
                        forget_whole(pairs, listed)
                    longest, again = NEVER, False
            if iterates:
                count_limits(workspace.collision, counters)
            if in_parts:
                gather(counters)
                if instant:
                    continue
            if ordered:
                note_acceleration(bodies, velocities, motion, params)
            if reaches:
                note_drive(state, count, params)
            moved = counters.projection_sweeps > 0
            diverged, cause = integrate(bodies, velocities, motion, state.pseudo, moved, params.dt)
            if ends:
                end_part(state, params)
            if ordered:
                if length < left and diverged < 0:
                    counters.elapsed += length
                    if controlled:
                        note_part(state.control, counters.elapsed)
                    continue
            if controlled:
                if diverged >= 0:
                    counters.body = diverged
                outcome = end_span(state, count, params, counter, log.step, diverged >= 0)
                if outcome == GO_ON:
                    continue
                if outcome == MISSED:
                    # The substep is taken back, with what it counted.
                    counters.cause = INACCURATE if diverged < 0 else cause
                    params.dt = params.timestep
                    return DIVERGED
            if in_parts:
                params.dt = params.timestep
            if sleeps:
                update_sleeping(state, count, workspace.islands, params)
            done += 1
            counters.step += 1
            counters.contacts = count
            if records:
                if linked:
                    log_links(log.step[counters.step_rows], state.links, bodies)
                if triggered:
                    met = meet_triggers(state, log, counters)
                log_step(bodies, velocities, params, counters, log)
            if in_parts:
                end_step(counters)
            if diverged >= 0:
                counters.body, counters.cause = diverged, cause
                return DIVERGED
            if triggered:
                if met > 0:
                    return RUNNING
        return RUNNING

    return kernel(advance, spec)


def kernels_of(spec: Spec) -> dict[str, list[str]]:
    """Return the kernels that an engine of `spec` is composed of, by module of `engine`.

    Module names are relative to the engine: `effects.friction`, `solvers.adaptive`, `step`.
    """
    with uncollected(), naming() as composed:
        make_advance(spec)
    engine = __name__.rpartition(".")[0] + "."
    kernels: dict[str, list[str]] = {}
    for module, name in dict.fromkeys(composed):
        kernels.setdefault(module.removeprefix(engine), []).append(name)
    return kernels


@cache
def advance_for(spec: Spec) -> Any:
    """Return the kernel of `spec`, from this process, from disk, or composed anew."""
    with uncollected():
        return cached(make_advance, spec)


def is_compiled(spec: Spec) -> bool:
    """Whether the kernel of `spec` is compiled already, in this process or on disk."""
    return not uncompiled([spec])


def uncompiled(specs: Iterable[Spec]) -> list[Spec]:
    """Return the specs, each once, whose kernel is compiled neither in this process nor on disk.

    The disk is read once for all of them, if at all: it may hold tens of thousands of files.
    """
    kernels = {spec: advance_for(spec) for spec in specs}
    absent = {spec: kernel for spec, kernel in kernels.items() if not kernel.overloads}
    kept = kernels_on_disk() if absent else set()
    return [spec for spec, kernel in absent.items() if not kernel._cache.is_of(kept)]
