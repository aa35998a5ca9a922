"""When a motor reaches its speed: a part of a step ends there, as where sliding stops.

    w + a t = 0,   t = -w/a    w: of the motor's row as a part begins; a: its rate in the last part
A motor drives by its most until w vanishes, and from then on holds, or pushes the other way, as one
of speed 0 does whose joint turns round. Impulses of one part have one of these; a part across that
instant is of first order, and exact under constant forces if it ends there. Where a changes, the
instant is missed by O(dt^2), and what is left of w then vanishes by itself.
"""

from __future__ import annotations

from typing import Any

from .approach import CREEP, NEVER, SHORT
from .compile import kernel
from .contact import make_frictionless_velocity
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, minus, plus

# A motor drives by its most that gives this share of it [-].
SPENDS = 1.0 - 1e-9
# What a step may spend on its parts, in rows that are solved again, and what one of these counts
# for at most: scenes of any size may have some, which leave impacts what they need.
SPENT, MOST_OF_A_PART = 512, 16


def reaches_speeds(spec: Spec) -> bool:
    """Whether parts of a step end where motors reach their speeds."""
    steps = step_terms(spec)
    return row_terms(spec).bounded and steps.ordered_impacts and steps.centred


def make_note_drive(spec: Spec) -> Any:
    """Return `kernel(state, count, params)`: the rates of motors in a part, once it is solved."""
    velocity_of = make_frictionless_velocity(spec)

    def note_drive(state, count, params):
        if params.dt < SHORT * params.timestep:
            return
        for c in range(count):
            contact = state.contacts[c]
            if contact.motor == 1:
                rate = 0.0  # of one that holds what solves leave has no instant
                if abs(contact.lambda_n) >= SPENDS * contact.most:
                    va, vb = state.velocities[contact.a], state.velocities[contact.b]
                    rate = (velocity_of(contact, va, vb) - contact.driven) / params.dt
                state.bodies[state.pairs[contact.pair].b].drive_rate = rate

    return kernel(note_drive, spec)


def make_first_reach(spec: Spec) -> Any:
    """Return `kernel(state, count, params, counters) -> when` a motor has its speed, or NEVER [s].

    params.dt: what is left of the step.
    """
    turns = row_terms(spec).levers

    def speed(contact, ma, mb):
        # Of a row that is found, and not completed yet [m/s].
        arm_a = Vec3(contact.arm_ax, contact.arm_ay, contact.arm_az)
        arm_b = Vec3(contact.arm_bx, contact.arm_by, contact.arm_bz)
        spin_a, spin_b = Vec3(ma.wx, ma.wy, ma.wz), Vec3(mb.wx, mb.wy, mb.wz)
        if contact.couple == 1:
            return dot(arm_b, minus(spin_b, spin_a))
        v = minus(Vec3(mb.vx, mb.vy, mb.vz), Vec3(ma.vx, ma.vy, ma.vz))
        v = minus(plus(v, cross(spin_b, arm_b)), cross(spin_a, arm_a))
        return dot(Vec3(contact.nx, contact.ny, contact.nz), v)

    def straight_speed(contact, ma, mb):
        return (
            contact.nx * (mb.vx - ma.vx)
            + contact.ny * (mb.vy - ma.vy)
            + (contact.nz * (mb.vz - ma.vz))
        )

    speed_of: Any = kernel(speed if turns else straight_speed, spec)

    def first_reach(state, count, params, counters):
        first, left = NEVER, params.dt
        share = min(1 + count, MOST_OF_A_PART)
        if counters.spent + share > SPENT:
            return first
        for c in range(count):
            contact = state.contacts[c]
            if contact.motor == 1:
                pair = state.pairs[contact.pair]
                w = speed_of(contact, state.motion[contact.a], state.motion[contact.b])
                w -= pair.motor_speed
                rate = state.bodies[pair.b].drive_rate
                if abs(w) > CREEP and w * rate < 0.0:
                    t = -w / rate
                    if SHORT * params.timestep < t < left - SHORT * params.timestep:
                        first = min(first, t)
        if first < left:
            counters.spent += share
        return first

    return kernel(first_reach, spec)
