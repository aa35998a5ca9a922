"""Gauss-Seidel sweeps over packed contacts: the update of `row_update`, one at a time or eight.

    w = J v + b + gamma lambda_n e_n        v_B - v_A in the contact's axes, and three turns of each
    lambda_n <- max(0, lambda_n - w_n / (k_n + gamma)),    w_t follows it
    lambda_t <- lambda_t - K_tt^-1 w_t      in the disc of radius mu lambda_n: stick
                proj(lambda_t - w_t / k_t)  otherwise: slide
    v_A -= p / m_A,   v_B += p / m_B,   y += J^T (change of lambda)
Some 170 operations on numbers a visit; of a contact alone, x, y and z are one vector's. One text
serves both widths: every lane makes the operations that a single contact makes, in the same order.
What slides is worked out where a contact, or any of eight, leaves its disc; the others do not take
it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...compile import kernel
from ...effects import made_once
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from ..iteration import Iteration
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
from .lanes import (
    WIDTH,
    any_greater,
    greater,
    lane,
    magnitude,
    positive,
    root,
    total,
    where_greater,
    zeros,
)
from .layout import (
    ALONE,
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
    TURN_A,
    TURN_B,
    W_1,
    W_2,
    W_N,
    N,
)
from .packing import make_pack, make_unpack


def can_pack(spec: Spec) -> bool:
    """Whether contacts of this engine are blocks of a normal and a disc, and nothing else."""
    frictional = row_terms(spec).frictional and not resists_turning(spec)
    plain = not spec.over_relaxation and spec.order != "symmetric"
    captured_once = not made_once(spec, "recapture")[0]
    return (
        frictional
        and plain
        and captured_once
        and spec.friction_cone == "disc"
        and spec.operator == "bodies"
    )


def _make_visit(spec: Spec, eight: bool) -> Any:
    """Return `kernel(packed, at, slot, most) -> most`.

    One projected update of the contact, or of the group, whose fields begin at `at`; most: the
    greatest change so far [m/s].
    """
    compliant = row_terms(spec).compliant
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

    def visit(packed, at, slot, most):
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
            squared = slid_1 * slid_1 + slid_2 * slid_2
            scale = limit / root(squared)
            slid_1 = where_greater(squared, disc, slid_1 * scale, slid_1)
            slid_2 = where_greater(squared, disc, slid_2 * scale, slid_2)
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
        put_state(state, first, slot, va, ya)
        put_state(state, second, slot, vb, yb)
        most = greater(magnitude(change_n) * take(rows, at, K_N), most)
        across = greater(magnitude(change_1), magnitude(change_2))
        return greater(across * take(rows, at, K_T), most)

    return kernel(visit, spec)


def make_sweep_packed(spec: Spec, eight: bool) -> Any:
    """Return `kernel(packed, slots) -> greatest change` [m/s]."""
    visit = _make_visit(spec, eight)

    def sweep_singly(packed, slots):
        most = 0.0
        for k in range(slots):
            most = visit(packed, k * ALONE, k, most)
        return most

    def sweep_by_eight(packed, slots):
        most = zeros()
        for g in range(slots // WIDTH):
            most = visit(packed, g * GROUP, g * WIDTH, most)
        greatest = lane(most, 0)
        for k in range(1, WIDTH):
            greatest = greater(lane(most, k), greatest)
        return greatest

    return kernel(sweep_by_eight if eight else sweep_singly, spec)


class PackedCarry(NamedTuple):
    """What sweeps over packed contacts carry, see `iteration.Carry`."""

    aim: float
    slots: int  # contacts, idle lanes included


def make_packed_iteration(spec: Spec, eight: bool) -> Iteration:
    """Return the sweeps over packed contacts; for a `spec` that `can_pack`."""
    pack, unpack = make_pack(spec, eight), make_unpack(spec, eight)
    sweep = make_sweep_packed(spec, eight)

    def prepare(system, workspace, params, counters):
        return PackedCarry(params.tolerance, pack(system, workspace))

    def sweep_packed(system, workspace, params, counters, carry):
        return sweep(workspace, carry.slots), carry

    def finish(system, workspace, carry):
        unpack(system, workspace)

    return Iteration(
        kernel(sweep_packed, spec), prepare=kernel(prepare, spec), finish=kernel(finish, spec)
    )
