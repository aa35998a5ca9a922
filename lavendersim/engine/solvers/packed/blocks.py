"""Blocks of a normal and a disc, packed: the update of `row_update`, of one contact or of eight.

    w = J v + b + gamma lambda_n e_n        v_B - v_A in the contact's axes, and three turns of each
    lambda_n <- max(0, lambda_n - w_n / (k_n + gamma)),    w_t follows it
    lambda_t <- lambda_t - K_tt^-1 w_t      in the disc of radius mu lambda_n: stick
                proj(lambda_t - w_t / k_t)  otherwise: slide
    v_A -= p / m_A,   v_B += p / m_B,   y += J^T (change of lambda)
Some 170 operations on numbers a visit; of a contact alone, x, y and z are one vector's. What slides
is worked out where a contact, or any of eight, leaves its disc; the others do not take it.
"""

from __future__ import annotations

from typing import Any

from ...block import make_slip_velocity
from ...compile import kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...vectors import Vec3
from .disc import make_project_disc
from .lane_memory import (
    put_bodies,
    put_body,
    put_eight,
    put_one,
    take_bodies,
    take_body,
    take_eight,
    take_one,
    take_triple,
    take_triples,
)
from .lanes import WIDTH, any_greater, greater, magnitude, positive, total, where_greater
from .layout import (
    AXIS,
    GAMMA,
    I_11,
    I_12,
    I_22,
    INV_K,
    INV_K_T,
    INV_M_A,
    INV_M_B,
    K_N,
    K_N1,
    K_N2,
    K_T,
    LAMBDA_1,
    LAMBDA_2,
    LAMBDA_N,
    MU,
    T1,
    T2,
    TURN_A,
    TURN_B,
    W_1,
    W_2,
    W_N,
    YIELDING,
    N,
    begins,
)
from .packing import make_put, make_put_arms, make_put_geometry
from .spins import make_visit_roll, make_visit_torsion


def make_pack_block(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, velocities, rows, at, factor)`: every field of a block."""
    terms = row_terms(spec)
    compliant, frictionless = terms.compliant, terms.frictionless
    yielding, gamma_t = terms.yielding, begins(spec).end - YIELDING
    slip_velocity = make_slip_velocity(spec)
    put, put_arms = make_put(spec, eight), make_put_arms(spec, eight)
    put_axis, _, put_turns = make_put_geometry(spec, eight)
    step = WIDTH if eight else 1

    def pack_block(contact, velocities, rows, at, factor):
        a, b = contact.a, contact.b
        put_axis(rows, at + N * step, contact.nx, contact.ny, contact.nz)
        put_axis(rows, at + T1 * step, contact.t1x, contact.t1y, contact.t1z)
        put_axis(rows, at + T2 * step, contact.t2x, contact.t2y, contact.t2z)
        turn_a, turn_b = at + TURN_A * step, at + TURN_B * step
        lever_a = Vec3(contact.rax, contact.ray, contact.raz)
        lever_b = Vec3(contact.rbx, contact.rby, contact.rbz)
        put_turns(rows, turn_a, factor[a], -1.0, contact, lever_a)
        put_turns(rows, turn_b, factor[b], 1.0, contact, lever_b)
        put(rows, at, INV_M_A, contact.inv_m_a)
        put(rows, at, INV_M_B, contact.inv_m_b)
        v_n, w_1, w_2 = slip_velocity(contact, velocities[a], velocities[b])
        put(rows, at, W_N, v_n + contact.target)
        if yielding:
            put(rows, at, gamma_t, contact.gamma_t)
            w_1 -= contact.gamma_t * contact.lambda_1
            w_2 -= contact.gamma_t * contact.lambda_2
        put(rows, at, W_1, w_1)
        put(rows, at, W_2, w_2)
        put(rows, at, INV_K, contact.inv_k)
        put(rows, at, K_N1, contact.k_n1)
        put(rows, at, K_N2, contact.k_n2)
        put(rows, at, I_11, contact.i_11)
        put(rows, at, I_12, contact.i_12)
        put(rows, at, I_22, contact.i_22)
        put(rows, at, INV_K_T, 1.0 / contact.k_t)
        put(rows, at, K_N, contact.k_n)
        put(rows, at, K_T, contact.k_t)
        put(rows, at, MU, contact.mu)
        if compliant:
            put(rows, at, GAMMA, contact.gamma)
        put(rows, at, LAMBDA_N, contact.lambda_n)
        put(rows, at, LAMBDA_1, contact.lambda_1)
        put(rows, at, LAMBDA_2, contact.lambda_2)
        if frictionless:
            if contact.frictional == 0:
                # It has a normal alone: no impulse across.
                put(rows, at, I_11, 0.0)
                put(rows, at, I_12, 0.0)
                put(rows, at, I_22, 0.0)
                put_arms(contact, factor, rows, turn_a, turn_b)

    return kernel(pack_block, spec)


def make_unpack_block(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, rows, at)`: impulses of a block."""
    step = WIDTH if eight else 1

    def unpack_block(contact, rows, at):
        contact.lambda_n = take_one(rows, at + LAMBDA_N * step)
        contact.lambda_1 = take_one(rows, at + LAMBDA_1 * step)
        contact.lambda_2 = take_one(rows, at + LAMBDA_2 * step)

    return kernel(unpack_block, spec)


def make_visit_block(spec: Spec, eight: bool) -> Any:
    """Return `kernel(packed, at, slot, own, most) -> most`.

    One projected update of the contact, or of the group, whose fields begin at `at`; most: the
    greatest change so far [m/s].
    """
    compliant, project_disc = row_terms(spec).compliant, make_project_disc(spec)
    yielding, gamma_t = row_terms(spec).yielding, begins(spec).end - YIELDING
    torsional, rolling = row_terms(spec).torsional, row_terms(spec).rolling
    visit_torsion: Any = make_visit_torsion(spec, eight) if torsional else None
    visit_roll: Any = make_visit_roll(spec, eight) if rolling else None
    step = WIDTH if eight else 1
    take_number, take_axis = (take_eight, take_triples) if eight else (take_one, take_triple)
    put_number = put_eight if eight else put_one
    take_state, put_state = (take_bodies, put_bodies) if eight else (take_body, put_body)

    def take(rows, at, field):
        return take_number(rows, at + field * step)

    take = kernel(take, spec)

    def axes(rows, at, field):
        # n, t1, t2, or what a body does about each
        return (
            take_axis(rows, at + field * step),
            take_axis(rows, at + (field + AXIS) * step),
            take_axis(rows, at + (field + 2 * AXIS) * step),
        )

    axes = kernel(axes, spec)

    def visit(packed, at, slot, own, most):
        rows, state = packed.rows, packed.state
        first, second = packed.first, packed.second
        va, ya = take_state(state, first, slot)
        vb, yb = take_state(state, second, slot)
        n, t1, t2 = axes(rows, at, N)
        a_n, a_1, a_2 = axes(rows, at, TURN_A)
        b_n, b_1, b_2 = axes(rows, at, TURN_B)
        v = vb - va
        w_n = total(n * v + a_n * ya + b_n * yb) + take(rows, at, W_N)
        w_1 = total(t1 * v + a_1 * ya + b_1 * yb) + take(rows, at, W_1)
        w_2 = total(t2 * v + a_2 * ya + b_2 * yb) + take(rows, at, W_2)
        old_n = take(rows, at, LAMBDA_N)
        old_1, old_2 = take(rows, at, LAMBDA_1), take(rows, at, LAMBDA_2)
        if compliant:
            w_n = w_n + take(rows, at, GAMMA) * old_n
        if yielding:
            w_1 = w_1 + take(rows, at, gamma_t) * old_1
            w_2 = w_2 + take(rows, at, gamma_t) * old_2
        new_n = positive(old_n - w_n * take(rows, at, INV_K))
        change_n = new_n - old_n
        w_1 = w_1 + take(rows, at, K_N1) * change_n
        w_2 = w_2 + take(rows, at, K_N2) * change_n
        i_12 = take(rows, at, I_12)
        new_1 = old_1 - take(rows, at, I_11) * w_1 - i_12 * w_2
        new_2 = old_2 - i_12 * w_1 - take(rows, at, I_22) * w_2
        limit = take(rows, at, MU) * new_n
        stick, disc = new_1 * new_1 + new_2 * new_2, limit * limit
        if any_greater(stick, disc):
            inv_k_t = take(rows, at, INV_K_T)
            slid_1, slid_2 = old_1 - w_1 * inv_k_t, old_2 - w_2 * inv_k_t
            slid_1, slid_2 = project_disc(slid_1, slid_2, limit)
            new_1 = where_greater(stick, disc, slid_1, new_1)
            new_2 = where_greater(stick, disc, slid_2, new_2)
        change_1, change_2 = new_1 - old_1, new_2 - old_2
        put_number(rows, at + LAMBDA_N * step, new_n)
        put_number(rows, at + LAMBDA_1 * step, new_1)
        put_number(rows, at + LAMBDA_2 * step, new_2)
        p = n * change_n + t1 * change_1 + t2 * change_2
        va = va - p * take(rows, at, INV_M_A)
        vb = vb + p * take(rows, at, INV_M_B)
        ya = ya + (a_n * change_n + a_1 * change_1 + a_2 * change_2)
        yb = yb + (b_n * change_n + b_1 * change_1 + b_2 * change_2)
        if torsional:
            ya, yb, most = visit_torsion(rows, at, new_n, ya, yb, most)
        if rolling:
            ya, yb, most = visit_roll(rows, at, new_n, ya, yb, most)
        put_state(state, first, slot, own, (va, ya))
        put_state(state, second, slot, own, (vb, yb))
        most = greater(magnitude(change_n) * take(rows, at, K_N), most)
        across = greater(magnitude(change_1), magnitude(change_2))
        return greater(across * take(rows, at, K_T), most)

    return kernel(visit, spec)
