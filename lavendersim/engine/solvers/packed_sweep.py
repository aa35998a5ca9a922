"""Packed contacts enter, impulses leave: the update of `row_update`, one at a time or eight.

    w = J v + b + gamma lambda_n e_n        v_B - v_A in the contact's axes, and three turns of each
    lambda_n <- max(0, lambda_n - w_n / (k_n + gamma)),    w_t follows it
    lambda_t <- lambda_t - K_tt^-1 w_t      in the disc of radius mu lambda_n: stick
                proj(lambda_t - w_t / k_t)  otherwise: slide
    v_A -= p / m_A,   v_B += p / m_B,   y += J^T (change of lambda)
Some 180 operations a visit. One text serves both widths: every lane makes the operations that a
single contact makes, in the same order. What slides is worked out where a contact, or any of eight,
leaves its disc; the others do not take it.
"""

from __future__ import annotations

from typing import Any

from ..compile import kernel
from ..residual import make_residual
from ..spec import Spec
from ..spin_block import resists_turning
from .lanes import (
    WIDTH,
    any_greater,
    greater,
    lane,
    magnitude,
    positive,
    put_bodies_eight,
    put_bodies_one,
    put_eight,
    put_one,
    root,
    take_bodies_eight,
    take_bodies_one,
    take_eight,
    take_one,
    where_greater,
    zeros,
)
from .packed_rows import (
    AXIS,
    GAMMA,
    GROUP,
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
    N,
    make_pack,
    make_unpack,
)
from .sweep import make_account, make_note


def can_pack(spec: Spec) -> bool:
    """Whether contacts of this engine are blocks of a normal and a disc, and nothing else."""
    rubs = spec.has("friction") and not resists_turning(spec)
    plain = not spec.over_relaxation and spec.order != "symmetric"
    return rubs and plain and spec.friction_cone == "disc" and spec.operator == "bodies"


def _make_visit(spec: Spec, eight: bool) -> Any:
    """Return `kernel(rows, at, state, first, second, slot, most) -> most`.

    One projected update of the contact or group at `at`; most: the greatest change so far [m/s].
    """
    compliant = spec.has("compliance")
    take, put = (take_eight, put_eight) if eight else (take_one, put_one)
    take_bodies = take_bodies_eight if eight else take_bodies_one
    put_bodies = put_bodies_eight if eight else put_bodies_one

    def along(rows, at, x, y, z):
        return take(rows, at) * x + take(rows, at + WIDTH) * y + take(rows, at + 2 * WIDTH) * z

    along = kernel(along, spec)

    def across(rows, at, n, one, two):
        # The same component of three axes: n, t1, t2.
        return take(rows, at) * n + take(rows, at + AXIS) * one + take(rows, at + 2 * AXIS) * two

    across = kernel(across, spec)

    def visit(rows, at, state, first, second, slot, most):
        ax, ay, az, ai, aj, ak = take_bodies(state, first, slot)
        bx, by, bz, bi, bj, bk = take_bodies(state, second, slot)
        x, y, z = bx - ax, by - ay, bz - az
        turn_a, turn_b = at + TURN_A, at + TURN_B
        w_n = along(rows, at + N, x, y, z) + along(rows, turn_a, ai, aj, ak)
        w_n = w_n + along(rows, turn_b, bi, bj, bk) + take(rows, at + W_N)
        w_1 = along(rows, at + T1, x, y, z) + along(rows, turn_a + AXIS, ai, aj, ak)
        w_1 = w_1 + along(rows, turn_b + AXIS, bi, bj, bk) + take(rows, at + W_1)
        w_2 = along(rows, at + T2, x, y, z) + along(rows, turn_a + 2 * AXIS, ai, aj, ak)
        w_2 = w_2 + along(rows, turn_b + 2 * AXIS, bi, bj, bk) + take(rows, at + W_2)
        old_n = take(rows, at + LAMBDA_N)
        old_1, old_2 = take(rows, at + LAMBDA_1), take(rows, at + LAMBDA_2)
        if compliant:
            w_n = w_n + take(rows, at + GAMMA) * old_n
        new_n = positive(old_n - w_n * take(rows, at + INV_K))
        n = new_n - old_n
        w_1 = w_1 + take(rows, at + K_N1) * n
        w_2 = w_2 + take(rows, at + K_N2) * n
        i_12 = take(rows, at + I_12)
        new_1 = old_1 - take(rows, at + I_11) * w_1 - i_12 * w_2
        new_2 = old_2 - i_12 * w_1 - take(rows, at + I_22) * w_2
        limit = take(rows, at + MU) * new_n
        stick, disc = new_1 * new_1 + new_2 * new_2, limit * limit
        if any_greater(stick, disc):
            inv_k_t = take(rows, at + INV_K_T)
            slid_1, slid_2 = old_1 - w_1 * inv_k_t, old_2 - w_2 * inv_k_t
            squared = slid_1 * slid_1 + slid_2 * slid_2
            scale = limit / root(squared)
            slid_1 = where_greater(squared, disc, slid_1 * scale, slid_1)
            slid_2 = where_greater(squared, disc, slid_2 * scale, slid_2)
            new_1 = where_greater(stick, disc, slid_1, new_1)
            new_2 = where_greater(stick, disc, slid_2, new_2)
        one, two = new_1 - old_1, new_2 - old_2
        put(rows, at + LAMBDA_N, new_n)
        put(rows, at + LAMBDA_1, new_1)
        put(rows, at + LAMBDA_2, new_2)
        x = across(rows, at, n, one, two)
        y = across(rows, at + WIDTH, n, one, two)
        z = across(rows, at + 2 * WIDTH, n, one, two)
        inv_m_a, inv_m_b = take(rows, at + INV_M_A), take(rows, at + INV_M_B)
        ax, ay, az = ax - x * inv_m_a, ay - y * inv_m_a, az - z * inv_m_a
        bx, by, bz = bx + x * inv_m_b, by + y * inv_m_b, bz + z * inv_m_b
        ai = ai + across(rows, turn_a, n, one, two)
        aj = aj + across(rows, turn_a + WIDTH, n, one, two)
        ak = ak + across(rows, turn_a + 2 * WIDTH, n, one, two)
        bi = bi + across(rows, turn_b, n, one, two)
        bj = bj + across(rows, turn_b + WIDTH, n, one, two)
        bk = bk + across(rows, turn_b + 2 * WIDTH, n, one, two)
        put_bodies(state, first, slot, (ax, ay, az, ai, aj, ak))
        put_bodies(state, second, slot, (bx, by, bz, bi, bj, bk))
        k_t = take(rows, at + K_T)
        most = greater(magnitude(n) * take(rows, at + K_N), most)
        most = greater(magnitude(one) * k_t, most)
        return greater(magnitude(two) * k_t, most)

    return kernel(visit, spec)


def make_sweep_packed(spec: Spec, eight: bool) -> Any:
    """Return `kernel(packed, groups, count) -> greatest change` [m/s]."""
    visit = _make_visit(spec, eight)

    def sweep_singly(packed, groups, count):
        most = 0.0
        for k in range(count):
            at = k // WIDTH * GROUP + k % WIDTH
            most = visit(packed.rows, at, packed.state, packed.first, packed.second, k, most)
        return most

    def sweep_by_eight(packed, groups, count):
        most = zeros()
        for g in range(groups):
            most = visit(
                packed.rows, g * GROUP, packed.state, packed.first, packed.second, g * WIDTH, most
            )
        greatest = lane(most, 0)
        for k in range(1, WIDTH):
            greatest = greater(lane(most, k), greatest)
        return greatest

    return kernel(sweep_by_eight if eight else sweep_singly, spec)


def make_solve_packed(spec: Spec, eight: bool) -> Any:
    """Return the solver's kernel, see `solvers`; for a `spec` that `can_pack`."""
    record_residuals, stop_early = spec.has("residual_log"), spec.tolerance
    pack, unpack = make_pack(spec, apart=eight), make_unpack(spec)
    sweep = make_sweep_packed(spec, eight)
    residual, note, account = make_residual(spec), make_note(spec), make_account(spec)

    def solve_packed(
        contacts, order, count, bodies, velocities, space, params, counters, residual_rows
    ):
        largest, worst = 0.0, -1
        if record_residuals:
            largest, worst = residual(contacts, count, velocities)
            note(params, counters, residual_rows, 0, largest)
        groups = pack(contacts, order, count, bodies, velocities, space)
        sweeps, measured = 0, False
        while sweeps < params.sweeps:
            greatest = sweep(space, groups, count)
            sweeps += 1
            measured = record_residuals
            if record_residuals:
                unpack(contacts, order, count, bodies, velocities, space)
                largest, worst = residual(contacts, count, velocities)
                note(params, counters, residual_rows, sweeps, largest)
            # A sweep that changes nothing is the last, and one that leaves a NaN.
            over = greatest == 0.0 or greatest != greatest
            if over:
                break
            if stop_early:
                # The residual is evaluated when the sweep's own changes say that it may be small.
                if greatest <= params.tolerance:
                    if not measured:
                        unpack(contacts, order, count, bodies, velocities, space)
                        largest, worst = residual(contacts, count, velocities)
                        measured = True
                    if largest <= params.tolerance:
                        break
        if not measured:
            unpack(contacts, order, count, bodies, velocities, space)
            largest, worst = residual(contacts, count, velocities)
        account(params, counters, sweeps, largest, worst)

    return kernel(solve_packed, spec)
