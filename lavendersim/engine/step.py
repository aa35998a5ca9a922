"""The step on one screen. A `Spec` enters, the kernel `advance` composed for it leaves.

accelerate   v += dt * forces
collide      contacts at the pose the step begins with, and those the step may make
append       each contact: frame, effective mass, what is captured once
warm start   impulses of contacts that persist
solve        velocities that respect every contact, and the trace rows of contacts
integrate    x += dt v
project      poses moved out of what still penetrates, without velocity
record       the trace row of the step
"""

from __future__ import annotations

from functools import cache
from typing import Any

from . import ordering
from .collide import broad_phase, narrow_phase
from .compile import chain, composing, kernel
from .contact import make_append_contact, make_apply_start
from .effects import compound as compound_effect
from .effects import (
    contact_log,
    friction,
    impact_energy,
    impact_time,
    made_by,
    pose_log,
    projection,
    sleeping,
    step_log,
    surface_fields,
    warm_start,
)
from .integrate import (
    keeps_motion,
    make_begin,
    make_classify,
    make_integrate,
    make_undo,
)
from .kernel_cache import cached
from .records import CONTACTS_FULL, DIVERGED, PAIRS_FULL, ROWS_FULL, RUNNING, WOKEN
from .solvers import SOLVERS
from .spec import Spec


def make_find_pairs(spec: Spec) -> Any:
    """Return the kernel of the broad phase; without one there is nothing to call."""
    if not spec.has("broad_phase"):
        return None
    return broad_phase.make(spec, surface_fields(spec))


def make_advance(spec: Spec) -> Any:
    """Compose `advance(bodies, velocities, motion, pseudo, bits, contacts, cache, pairs, work,
    parameters, counter, rows, residual_rows, steps) -> status`; counter says how many steps are
    done.
    """
    accelerations = made_by(spec, "make", "accelerate")
    accelerates, keeps = bool(accelerations), keeps_motion(spec)
    accelerate = chain(accelerations, spec)
    begin: Any = make_begin(spec, accelerate) if keeps else None
    undo: Any = make_undo(spec) if keeps else None
    classify: Any = make_classify(spec) if keeps else None
    integrate = make_integrate(spec)

    touches = bool(spec.shape_pairs)
    collide: Any = narrow_phase.make(spec) if touches else None
    append_contact: Any = None
    if touches:
        append_contact = make_append_contact(spec, chain(made_by(spec, "make", "capture"), spec))
    order_contacts: Any = ordering.make(spec) if touches else None
    solve: Any = SOLVERS[spec.solver].make(spec) if touches else None
    apply_start: Any = make_apply_start(spec) if spec.has("warm_start") else None

    strikes, strike = spec.made(impact_time, "make_strike")
    rubs, refresh = spec.made(friction, "make_refresh")
    compound, place_parts = spec.made(compound_effect)
    warms, match_contacts = spec.made(warm_start)
    _, store_contacts = spec.made(warm_start, "make_store")
    projects, project_positions = spec.made(projection)
    sleeps, set_pace = spec.made(sleeping, "make_set_pace")
    _, wake = spec.made(sleeping, "make_wake")
    _, doze = spec.made(sleeping, "make_doze")
    watched, note = spec.made(impact_energy, "make_note")
    settle: Any = impact_energy.make_settle(spec, solve, classify) if watched else None
    broad, find_pairs = spec.has("broad_phase"), make_find_pairs(spec)
    record_residuals = spec.has("residual_log")
    records, logs_contacts = spec.has("step_log"), spec.has("contact_log")
    log_step: Any = None
    log_contacts: Any = None
    if records:
        log_step = step_log.make(spec, pose_log.make(spec), made_by(spec, "make_step_log"))
    if logs_contacts:
        log_contacts = contact_log.make(spec, made_by(spec, "make_log"))

    def advance(
        bodies, velocities, motion, pseudo, bits, contacts, cache, pairs, work, parameters,
        counter, rows, residual_rows, steps,
    ):  # fmt: skip
        points, normal, scratch, taken, buckets, keys, order, space, templates, near = work
        params, counters = parameters[0], counter[0]
        if records:
            if counters.started == 0:
                log_step(bodies, velocities, bits, params, counters, rows)
        counters.started = 1
        for _ in range(steps):
            if records:
                if counters.step_rows == rows[0].shape[0]:
                    return ROWS_FULL
            if record_residuals:
                if counters.residual_rows + params.sweeps + 1 > residual_rows.shape[0]:
                    return ROWS_FULL
            if sleeps:
                set_pace(bodies, velocities)
            if keeps:
                begin(bodies, velocities, motion, params)
            if rubs:
                refresh(bodies, velocities)
            if compound:
                place_parts(bodies)
            listed = pairs.shape[0]
            if broad:
                listed = find_pairs(bodies, velocities, pairs, templates, params, near)
            count = 0
            if touches:
                if listed >= 0:
                    count = collide(
                        bodies, motion, pairs, listed, contacts, points, normal, scratch, params.dt
                    )
            full = RUNNING
            if listed < 0:
                full = PAIRS_FULL
            elif count < 0:
                full = CONTACTS_FULL
            if records:
                if full == RUNNING and counters.contact_rows + count > rows[2].shape[0]:
                    full = ROWS_FULL
            if sleeps:
                if full == RUNNING and wake(bodies, contacts, count, params):
                    full = WOKEN
            if full != RUNNING:
                if keeps:
                    undo(velocities, motion)
                return full
            if accelerates and not keeps:
                for i in range(bodies.shape[0]):
                    if bodies[i].inv_m > 0.0:
                        accelerate(bodies[i], velocities[i], params)
            if touches:
                for c in range(count):
                    contact, pair = contacts[c], pairs[contacts[c].pair]
                    append_contact(contact, bodies, velocities, motion, pair, params)
            if watched:
                for c in range(count):
                    contact = contacts[c]
                    note(contact, velocities[contact.a], velocities[contact.b])
            if strikes:
                strike(contacts, count, motion, params)
            if warms:
                match_contacts(contacts, count, bodies, cache, counters, params)
                for c in range(count):
                    contact = contacts[c]
                    if contact.lambda_n > 0.0:
                        va, vb = velocities[contact.a], velocities[contact.b]
                        apply_start(contact, va, vb)
            if touches:
                order_contacts(bodies, contacts, count, taken, buckets, keys, order)
                solve(
                    contacts, order, count, bodies, velocities, space, params, counters,
                    residual_rows,
                )  # fmt: skip
            if watched:
                settle(
                    contacts, order, count, bodies, velocities, motion, space, params, counters,
                    residual_rows,
                )  # fmt: skip
            if logs_contacts:
                log_contacts(contacts, count, velocities, params, counters, rows)
            if warms:
                store_contacts(contacts, count, bodies, cache, counters, params)
            if projects:
                counters.projection_sweeps = project_positions(
                    contacts, order, count, velocities, pseudo, params
                )
            if keeps:
                classify(contacts, count, motion, params)
            moved = counters.projection_sweeps > 0
            diverged, cause = integrate(bodies, velocities, motion, pseudo, moved, params.dt)
            if sleeps:
                doze(bodies, velocities, motion, contacts, count, taken, params)
            counters.step += 1
            counters.contacts = count
            if records:
                log_step(bodies, velocities, bits, params, counters, rows)
            if diverged >= 0:
                counters.body, counters.cause = diverged, cause
                return DIVERGED
        return RUNNING

    return kernel(advance, spec)


def kernels_of(spec: Spec) -> dict[str, list[str]]:
    """Return the kernels that an engine of `spec` is composed of, by module of `engine`.

    Module names are relative to the engine: `effects.friction`, `solvers.adaptive`, `step`.
    """
    with composing() as composed:
        make_advance(spec)
    engine = __name__.rpartition(".")[0] + "."
    kernels: dict[str, list[str]] = {}
    for module, name in dict.fromkeys(composed):
        kernels.setdefault(module.removeprefix(engine), []).append(name)
    return kernels


@cache
def advance_for(spec: Spec) -> Any:
    """Return the kernel of `spec`, from this process, from disk, or composed anew."""
    return cached(make_advance, spec)


def is_compiled(spec: Spec) -> bool:
    """Whether the kernel of `spec` is compiled already, in this process or on disk."""
    dispatcher = advance_for(spec)
    return bool(dispatcher.overloads) or dispatcher._cache.holds()
