"""The step on one screen. A `Spec` enters, the kernel `advance` composed for it leaves.

collide      contacts at the pose the step begins with
accelerate   v += dt * forces
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
from .collide import narrow_phase
from .compile import chain, kernel
from .contact import make_append_contact, make_apply_impulse
from .effects import EFFECTS, gyroscopic, projection, rotation, warm_start
from .kernel_cache import cached
from .record import make as make_record
from .records import (
    CONTACTS_FULL,
    DIVERGED,
    NOT_FINITE,
    ROWS_FULL,
    RUNNING,
    TURNS_TOO_FAST,
)
from .rotation import turn
from .solvers import SOLVERS
from .spec import Spec


def make_integrate(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, pseudo, moved, dt) -> (diverged body or -1, cause)`."""
    turns, torque, projects = (
        spec.has("rotation"),
        spec.has("contact_torque"),
        spec.has("projection"),
    )
    integrate_rotation = (gyroscopic if spec.has("gyroscopic") else rotation).make(spec)

    def integrate(bodies, velocities, pseudo, moved, dt):
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            if body.inv_m > 0.0:
                body.x += v.vx * dt
                body.y += v.vy * dt
                body.z += v.vz * dt
                solved = True
                if turns:
                    solved = integrate_rotation(body, v, dt)
                if projects:
                    if moved:
                        u = pseudo[i]
                        body.x += u.vx
                        body.y += u.vy
                        body.z += u.vz
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


def make_advance(spec: Spec) -> Any:
    """Compose `advance(bodies, velocities, pseudo, bits, contacts, cache, pairs, work, parameters,
    counter, rows, residual_rows, steps) -> status`; counter says how many steps are done.
    """
    collide = narrow_phase.make(spec)
    stage = {
        name: [e.make(spec) for e in EFFECTS if e.STAGE == name and spec.has(e.NAME)]
        for name in ("accelerate", "capture")
    }
    accelerate = chain(stage["accelerate"], spec)
    append_contact = make_append_contact(spec, chain(stage["capture"], spec))
    apply_impulse = make_apply_impulse(spec)
    match_contacts, store_contacts = warm_start.make(spec), warm_start.make_store(spec)
    order_contacts = ordering.make(spec)
    solve = SOLVERS[spec.solver].make(spec)
    integrate = make_integrate(spec)
    project_positions = projection.make(spec)
    record_contacts, record_state = make_record(spec)
    accelerates, warms, projects = (
        bool(stage["accelerate"]),
        spec.has("warm_start"),
        spec.has("projection"),
    )
    records, record_residuals = spec.record, spec.record_residuals

    def advance(
        bodies, velocities, pseudo, bits, contacts, cache, pairs, work, parameters, counter,
        rows, residual_rows, steps,
    ):  # fmt: skip
        points, normal, scratch, taken, buckets, keys, order = work
        params, counters = parameters[0], counter[0]
        if records:
            if counters.started == 0:
                record_contacts(contacts, 0, velocities, params, counters, rows)
                record_state(bodies, velocities, bits, params, counters, rows)
        counters.started = 1
        for _ in range(steps):
            if records:
                if counters.step_rows == rows[0].shape[0]:
                    return ROWS_FULL
            if record_residuals:
                if counters.residual_rows + params.sweeps + 1 > residual_rows.shape[0]:
                    return ROWS_FULL
            count = collide(bodies, pairs, contacts, points, normal, scratch)
            if count < 0:
                return CONTACTS_FULL
            if records:
                if counters.contact_rows + count > rows[2].shape[0]:
                    return ROWS_FULL
            if accelerates:
                for i in range(bodies.shape[0]):
                    if bodies[i].inv_m > 0.0:
                        accelerate(bodies[i], velocities[i], params)
            for c in range(count):
                contact = contacts[c]
                append_contact(contact, bodies, velocities, pairs[contact.pair], params)
            if warms:
                match_contacts(contacts, count, bodies, cache, counters, params)
                for c in range(count):
                    contact = contacts[c]
                    if contact.lambda_n > 0.0:
                        va, vb = velocities[contact.a], velocities[contact.b]
                        apply_impulse(contact, va, vb, contact.lambda_n)
            order_contacts(bodies, contacts, count, taken, buckets, keys, order)
            solve(contacts, order, count, velocities, params, counters, residual_rows)
            if records:
                record_contacts(contacts, count, velocities, params, counters, rows)
            if warms:
                store_contacts(contacts, count, bodies, cache, counters, params)
            if projects:
                counters.projection_sweeps = project_positions(
                    contacts, order, count, velocities, pseudo, params
                )
            moved = counters.projection_sweeps > 0
            diverged, cause = integrate(bodies, velocities, pseudo, moved, params.dt)
            counters.step += 1
            counters.contacts = count
            if records:
                record_state(bodies, velocities, bits, params, counters, rows)
            if diverged >= 0:
                counters.body, counters.cause = diverged, cause
                return DIVERGED
        return RUNNING

    return kernel(advance, spec)


@cache
def advance_for(spec: Spec) -> Any:
    """Return the kernel of `spec`, from this process, from disk, or composed anew."""
    return cached(make_advance, spec)


def is_compiled(spec: Spec) -> bool:
    """Whether the kernel of `spec` is compiled already, in this process or on disk."""
    dispatcher = advance_for(spec)
    return bool(dispatcher.overloads) or dispatcher._cache.holds()
