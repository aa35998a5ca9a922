"""The solver row of a contact point: frame, effective mass, and what is captured once.

    k_n = 1/m_A + 1/m_B + n . [(I_A^-1 (r_A x n)) x r_A + (I_B^-1 (r_B x n)) x r_B]
        = 1/m_A + 1/m_B + (r_A x n) . I_A^-1 (r_A x n) + (r_B x n) . I_B^-1 (r_B x n)

The restitution target belongs here and nowhere else: it is captured from the velocity before the
solve. Taken inside the sweeps it would erase the bounce after the first sweep.
"""

from __future__ import annotations

from typing import Any

from .block import make_apply_vector, make_complete_block, make_relative_velocity
from .collide.nearest_image import place_beside
from .collide.records import UNBOUNDED
from .compile import chain, inner, kernel
from .effects import has_hook, made_by, made_once
from .integrate import keeps_motion
from .records import SPHERE
from .rotation import inverse_inertia_times
from .row_terms import by_friction, row_terms
from .spec import Spec
from .spin_block import (
    make_apply_start_torques,
    make_complete_spin,
    make_resists_turning,
    resists_turning,
)
from .step_terms import step_terms
from .vectors import Vec3, cross, length


@inner
def add_levers(contact, body_a, body_b, b, round_a, round_b):
    """Fill the angular parts of a row; returns what they add to k_n [1/kg].

    b: where B's centre is when the surfaces meet, across n [m]. round_a, round_b: whether every
    normal of the body passes through its centre: what the product leaves is round-off.
    """
    nx, ny, nz = contact.nx, contact.ny, contact.nz
    rx, ry, rz = contact.x - body_a.x, contact.y - body_a.y, contact.z - body_a.z
    lx, ly, lz = ry * nz - rz * ny, rz * nx - rx * nz, rx * ny - ry * nx
    if round_a:
        lx, ly, lz = 0.0, 0.0, 0.0
    tx, ty, tz = inverse_inertia_times(body_a, lx, ly, lz)
    contact.lever_ax, contact.lever_ay, contact.lever_az = lx, ly, lz
    contact.turn_ax, contact.turn_ay, contact.turn_az = tx, ty, tz
    k = lx * tx + ly * ty + lz * tz
    rx, ry, rz = contact.x - b.x, contact.y - b.y, contact.z - b.z
    lx, ly, lz = ry * nz - rz * ny, rz * nx - rx * nz, rx * ny - ry * nx
    if round_b:
        lx, ly, lz = 0.0, 0.0, 0.0
    tx, ty, tz = inverse_inertia_times(body_b, lx, ly, lz)
    contact.lever_bx, contact.lever_by, contact.lever_bz = lx, ly, lz
    contact.turn_bx, contact.turn_by, contact.turn_bz = tx, ty, tz
    return k + lx * tx + ly * ty + lz * tz


@inner
def add_arms(contact, body_a, body_b):
    """Fill the angular parts of a joint's row, which has its arms; returns what they add to k_n."""
    n = Vec3(contact.nx, contact.ny, contact.nz)
    lever = cross(Vec3(contact.arm_ax, contact.arm_ay, contact.arm_az), n)
    x, y, z = inverse_inertia_times(body_a, lever.x, lever.y, lever.z)
    contact.lever_ax, contact.lever_ay, contact.lever_az = lever.x, lever.y, lever.z
    contact.turn_ax, contact.turn_ay, contact.turn_az = x, y, z
    k = lever.x * x + lever.y * y + lever.z * z
    lever = cross(Vec3(contact.arm_bx, contact.arm_by, contact.arm_bz), n)
    x, y, z = inverse_inertia_times(body_b, lever.x, lever.y, lever.z)
    contact.lever_bx, contact.lever_by, contact.lever_bz = lever.x, lever.y, lever.z
    contact.turn_bx, contact.turn_by, contact.turn_bz = x, y, z
    return k + lever.x * x + lever.y * y + lever.z * z


@inner
def add_couple(contact, body_a, body_b):
    """Fill the angular parts of a motor's row, which turns about its arms; returns k_n."""
    x, y, z = contact.arm_ax, contact.arm_ay, contact.arm_az
    contact.lever_ax, contact.lever_ay, contact.lever_az = x, y, z
    contact.lever_bx, contact.lever_by, contact.lever_bz = x, y, z
    tx, ty, tz = inverse_inertia_times(body_a, x, y, z)
    contact.turn_ax, contact.turn_ay, contact.turn_az = tx, ty, tz
    k = x * tx + y * ty + z * tz
    tx, ty, tz = inverse_inertia_times(body_b, x, y, z)
    contact.turn_bx, contact.turn_by, contact.turn_bz = tx, ty, tz
    return k + x * tx + y * ty + z * tz


def make_normal_velocity(spec: Spec):
    """Return `kernel(contact, va, vb) -> v_n`, the velocity of B relative to A along n [m/s]."""
    return by_friction(spec, make_frictionless_velocity, _make_frictional_velocity)


def _make_frictional_velocity(spec: Spec):
    relative_velocity = make_relative_velocity(spec)

    def block_normal_velocity(contact, va, vb):
        x, y, z = relative_velocity(contact, va, vb)
        return contact.nx * x + contact.ny * y + contact.nz * z

    return kernel(block_normal_velocity, spec)


def make_frictionless_velocity(spec: Spec):
    """Return `kernel(contact, va, vb) -> v_n` of a row without friction [m/s]."""
    torque = row_terms(spec).levers

    def normal_velocity(contact, va, vb):
        v_n = (
            contact.nx * (vb.vx - va.vx)
            + contact.ny * (vb.vy - va.vy)
            + contact.nz * (vb.vz - va.vz)
        )
        if torque:
            v_n += (
                contact.lever_bx * vb.wx
                + contact.lever_by * vb.wy
                + contact.lever_bz * vb.wz
                - contact.lever_ax * va.wx
                - contact.lever_ay * va.wy
                - contact.lever_az * va.wz
            )
        return v_n

    return kernel(normal_velocity, spec)


def make_apply_impulse(spec: Spec):
    """Return `kernel(contact, va, vb, impulse)`: + on B, - on A, along n [N s]."""
    return by_friction(spec, make_frictionless_impulse, _make_frictional_impulse)


def _make_frictional_impulse(spec: Spec):
    apply_vector = make_apply_vector(spec)

    def apply_block_impulse(contact, va, vb, impulse):
        apply_vector(
            contact, va, vb, contact.nx * impulse, contact.ny * impulse, contact.nz * impulse
        )

    return kernel(apply_block_impulse, spec)


def make_frictionless_impulse(spec: Spec):
    """Return `kernel(contact, va, vb, impulse)` of a row without friction."""
    torque = row_terms(spec).levers

    def apply_impulse(contact, va, vb, impulse):
        pa, pb = impulse * contact.inv_m_a, impulse * contact.inv_m_b
        va.vx -= contact.nx * pa
        va.vy -= contact.ny * pa
        va.vz -= contact.nz * pa
        vb.vx += contact.nx * pb
        vb.vy += contact.ny * pb
        vb.vz += contact.nz * pb
        if torque:
            va.wx -= contact.turn_ax * impulse
            va.wy -= contact.turn_ay * impulse
            va.wz -= contact.turn_az * impulse
            vb.wx += contact.turn_bx * impulse
            vb.wy += contact.turn_by * impulse
            vb.wz += contact.turn_bz * impulse

    return kernel(apply_impulse, spec)


def make_apply_block(spec: Spec):
    """Return `kernel(contact, va, vb, n, one, two)`: + on B, - on A, along n, t1, t2 [N s].

    Without friction there is only n.
    """
    return by_friction(spec, _make_apply_normal, make_apply_all)


def _make_apply_normal(spec: Spec):
    apply_impulse = make_frictionless_impulse(spec)

    def apply_normal(contact, va, vb, n, one, two):
        apply_impulse(contact, va, vb, n)

    return kernel(apply_normal, spec)


def make_apply_all(spec: Spec):
    """Return `kernel(contact, va, vb, n, one, two)` of a frictional contact."""
    apply_vector = make_apply_vector(spec)

    def apply_block(contact, va, vb, n, one, two):
        apply_vector(
            contact,
            va,
            vb,
            contact.nx * n + contact.t1x * one + contact.t2x * two,
            contact.ny * n + contact.t1y * one + contact.t2y * two,
            contact.nz * n + contact.t1z * one + contact.t2z * two,
        )

    return kernel(apply_block, spec)


def make_apply_start(spec: Spec):
    """Return `kernel(contact, va, vb)`: apply the impulses the contact starts the solve with."""
    friction, apply_block = row_terms(spec).frictional, make_apply_block(spec)
    spins, apply_start_torques = resists_turning(spec), make_apply_start_torques(spec)

    def apply_start(contact, va, vb):
        one, two = 0.0, 0.0
        if friction:
            one, two = contact.lambda_1, contact.lambda_2
        apply_block(contact, va, vb, contact.lambda_n, one, two)
        if spins:
            apply_start_torques(contact, va, vb)

    return kernel(apply_start, spec)


def make_complete_row(spec: Spec):
    """Return `kernel(contact, body_a, body_b) -> k_n` of a row without friction: its levers."""
    torque, swept = row_terms(spec).levers, row_terms(spec).swept
    ropes, bilateral = row_terms(spec).taut, row_terms(spec).bilateral
    bounded, stopped = row_terms(spec).bounded, row_terms(spec).stopped
    beside = place_beside(spec)

    def complete_row(contact, body_a, body_b):
        k_n = body_a.inv_m + body_b.inv_m
        if torque:
            b = beside(body_a, body_b)
            if swept:
                b = Vec3(
                    b.x + contact.tangential_x,
                    b.y + contact.tangential_y,
                    b.z + contact.tangential_z,
                )
            round_a, round_b = body_a.shape == SPHERE, body_b.shape == SPHERE
            if ropes:
                if contact.span > 0.0:
                    round_a, round_b = False, False
            if stopped:
                if contact.stop == 1:
                    round_a, round_b = False, False
            if bounded:
                if contact.couple == 1:
                    return add_couple(contact, body_a, body_b)
            if bilateral:
                if contact.bilateral == 1:
                    return k_n + add_arms(contact, body_a, body_b)
            k_n += add_levers(contact, body_a, body_b, b, round_a, round_b)
        return k_n

    return kernel(complete_row, spec)


def make_stirred(spec: Spec):
    """Return `kernel(body_a, body_b, motion, contact, params) -> speed`, of the ends of a rope.

    What accelerates both bodies in a timestep, in any direction [m/s]: forces, and where impacts
    are in order what the bodies did in the last part of a step.
    """
    kept, forced = step_terms(spec).ordered_impacts, keeps_motion(spec)

    def stirred(body_a, body_b, motion, contact, params):
        speed = 0.0
        if forced:
            ma, mb = motion[contact.a], motion[contact.b]
            speed += length(Vec3(ma.dvx, ma.dvy, ma.dvz)) + length(Vec3(mb.dvx, mb.dvy, mb.dvz))
            speed *= params.timestep / params.dt
        if kept:
            a, b = body_a, body_b
            last = length(Vec3(a.ax, a.ay, a.az)) + length(Vec3(b.ax, b.ay, b.az))
            speed += params.timestep * last
        return speed

    return kernel(stirred, spec)


def make_append_contact(spec: Spec, capture):
    """Return `kernel(contact, bodies, velocities, motion, pair, params)` that completes a row.

    `capture` is the chain of effects that add to the row's target and compliance.
    """
    terms = row_terms(spec)
    friction, frictionless = terms.frictional, terms.frictionless
    compliant = terms.compliant
    step = step_terms(spec)
    at_surface = step.timed_impacts
    forced = at_surface or step.mean_flight or step.centred
    normal_velocity = make_normal_velocity(spec)
    complete_block: Any = make_complete_block(spec) if friction else None
    spins = resists_turning(spec)
    complete_spin: Any = make_complete_spin(spec) if spins else None
    pair_resists_turning: Any = make_resists_turning(spec) if spins else None
    complete_row: Any = make_complete_row(spec) if frictionless else None
    preparing = made_by(spec, "prepare")
    prepares = bool(preparing)
    prepare: Any = chain(preparing, spec) if prepares else None
    slows = at_surface and has_hook(spec, "slowed_n")
    slowed_n: Any = made_once(spec, "slowed_n")[1] if slows else None
    ropes, bilateral, bounded = row_terms(spec).taut, terms.bilateral, terms.bounded
    yields, yield_row = made_once(spec, "yield_row")
    stirred: Any = make_stirred(spec) if ropes else None

    def append_contact(contact, bodies, velocities, motion, pair, params):
        body_a, body_b = bodies[contact.a], bodies[contact.b]
        va, vb = velocities[contact.a], velocities[contact.b]
        contact.inv_m_a, contact.inv_m_b = body_a.inv_m, body_b.inv_m
        k_n = 0.0
        frictional = False
        if friction:
            k_n = complete_block(contact, body_a, body_b, va, vb, pair)
            frictional = pair.friction > 0.0
            if spins:
                complete_spin(contact, va, vb, pair)
                frictional = frictional or pair_resists_turning(pair)
            if frictionless:
                contact.frictional = 1 if frictional else 0
        if frictionless:
            if not frictional:
                k_n = complete_row(contact, body_a, body_b)
        contact.k_n = k_n
        if prepares:
            prepare(contact, va, vb, pair, params)
        contact.v_n_pre = normal_velocity(contact, va, vb)
        if forced:
            ma, mb = motion[contact.a], motion[contact.b]
            contact.dv_n = (
                contact.nx * (mb.dvx - ma.dvx)
                + contact.ny * (mb.dvy - ma.dvy)
                + contact.nz * (mb.dvz - ma.dvz)
            )
        if slows:
            contact.slowed_n = slowed_n(contact, body_a, body_b)
        if ropes:
            contact.stirred = 0.0
            if contact.span > 0.0:
                contact.stirred = stirred(body_a, body_b, motion, contact, params)
        if at_surface:
            contact.e = 0.0
        contact.target = 0.0
        contact.lambda_n = 0.0
        if compliant:
            contact.gamma = 0.0
        capture(contact, pair, params)
        if bilateral:
            if contact.bilateral == 1:  # its ends are together, and stay
                contact.target = 0.0
                if friction:
                    contact.mu, contact.lambda_1, contact.lambda_2 = 0.0, 0.0, 0.0
                if bounded:
                    contact.most = UNBOUNDED
                    if contact.motor == 1:
                        contact.target, contact.most = (
                            -pair.motor_speed,
                            pair.motor_most * params.dt,
                        )
                        contact.driven = contact.v_n_pre
                        if forced:
                            ma, mb = motion[contact.a], motion[contact.b]
                            contact.driven = normal_velocity(contact, ma, mb)
        softened = k_n
        if compliant:
            softened += contact.gamma
        contact.inv_k = 1.0 / softened
        if yields:
            contact.gamma_t, contact.yield_k = 0.0, 0.0
            if frictional:
                yield_row(contact, pair, motion[contact.a], motion[contact.b], params)

    return kernel(append_contact, spec)
