"""Torsional and rolling friction of packed contacts: the updates of `spin_block`, of one or eight.

    omega_n = J_n y + omega_0,    psi_n <- clamp(psi_n - omega_n / k, +-c lambda_n)
    omega_t = J_t y + omega_0,    psi_t <- psi_t - S_tt^-1 omega_t     in the disc of c lambda_n
                                           proj(psi_t - omega_t / k)   otherwise
    y += J^T (change of psi),     J = L_B^T axis - L_A^T axis of the two bodies (`layout`)
They follow the block of the same contact, with its new lambda_n. A pair without one of them has
c = 0: its psi stays 0, and moves nothing.
"""

from __future__ import annotations

from typing import Any

from ...compile import chain, kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...vectors import Vec3
from .disc import make_project_disc
from .lane_memory import put_eight, put_one, take_eight, take_one, take_triple, take_triples
from .lanes import WIDTH, any_greater, clamped, greater, magnitude, total, where_greater
from .layout import (
    AXIS,
    C_ROLL,
    C_TORSION,
    H_11,
    H_12,
    H_22,
    INV_ROLL,
    INV_TORSION,
    PSI_1,
    PSI_2,
    PSI_N,
    ROLL_A,
    ROLL_B,
    ROLL_SPEED,
    TORSION_A,
    TORSION_B,
    TORSION_SPEED,
    W_ROLL_1,
    W_ROLL_2,
    W_TORSION,
    begins,
)
from .packing import make_put, make_put_geometry


def _make_relative_spin(spec: Spec) -> Any:
    """Return `kernel(velocities, contact, axis)`: of B relative to A about an axis [rad/s]."""

    def relative_spin(velocities, contact, axis):
        va, vb = velocities[contact.a], velocities[contact.b]
        x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
        return axis.x * x + axis.y * y + axis.z * z

    return kernel(relative_spin, spec)


def make_pack_spins(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, velocities, rows, at, factor)`: the fields of what is there."""
    torsional, rolling = row_terms(spec).torsional, row_terms(spec).rolling
    kernels = [_make_pack_torsion(spec, eight)] if torsional else []
    return chain([*kernels, *([_make_pack_roll(spec, eight)] if rolling else [])], spec)


def _make_pack_torsion(spec: Spec, eight: bool) -> Any:
    put, (_, put_turn, _) = make_put(spec, eight), make_put_geometry(spec, eight)
    relative_spin = _make_relative_spin(spec)
    step, begin = WIDTH if eight else 1, begins(spec).torsion * (WIDTH if eight else 1)

    def pack_torsion(contact, velocities, rows, at, factor):
        at = at + begin
        n = Vec3(contact.nx, contact.ny, contact.nz)
        put_turn(rows, at + TORSION_A * step, factor[contact.a], -1.0, n)
        put_turn(rows, at + TORSION_B * step, factor[contact.b], 1.0, n)
        put(rows, at, W_TORSION, relative_spin(velocities, contact, n))
        put(rows, at, INV_TORSION, 1.0 / contact.k_torsion)
        put(rows, at, C_TORSION, contact.torsional)
        put(rows, at, PSI_N, contact.psi_n)
        put(rows, at, TORSION_SPEED, contact.k_torsion * contact.arm)

    return kernel(pack_torsion, spec)


def _make_pack_roll(spec: Spec, eight: bool) -> Any:
    put, (_, put_turn, _) = make_put(spec, eight), make_put_geometry(spec, eight)
    relative_spin = _make_relative_spin(spec)
    step, begin = WIDTH if eight else 1, begins(spec).roll * (WIDTH if eight else 1)

    def pack_roll(contact, velocities, rows, at, factor):
        at = at + begin
        own_a, own_b = factor[contact.a], factor[contact.b]
        t1 = Vec3(contact.t1x, contact.t1y, contact.t1z)
        t2 = Vec3(contact.t2x, contact.t2y, contact.t2z)
        put_turn(rows, at + ROLL_A * step, own_a, -1.0, t1)
        put_turn(rows, at + (ROLL_A + AXIS) * step, own_a, -1.0, t2)
        put_turn(rows, at + ROLL_B * step, own_b, 1.0, t1)
        put_turn(rows, at + (ROLL_B + AXIS) * step, own_b, 1.0, t2)
        put(rows, at, W_ROLL_1, relative_spin(velocities, contact, t1))
        put(rows, at, W_ROLL_2, relative_spin(velocities, contact, t2))
        put(rows, at, H_11, contact.h_11)
        put(rows, at, H_12, contact.h_12)
        put(rows, at, H_22, contact.h_22)
        put(rows, at, INV_ROLL, 1.0 / contact.k_roll)
        put(rows, at, C_ROLL, contact.rolling)
        put(rows, at, PSI_1, contact.psi_1)
        put(rows, at, PSI_2, contact.psi_2)
        put(rows, at, ROLL_SPEED, contact.k_roll * contact.arm)

    return kernel(pack_roll, spec)


def make_unpack_spins(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, rows, at)`: angular impulses of what is there."""
    torsional, rolling = row_terms(spec).torsional, row_terms(spec).rolling
    step, (torsion, roll, _) = WIDTH if eight else 1, begins(spec)

    def unpack_spins(contact, rows, at):
        if torsional:
            contact.psi_n = take_one(rows, at + (torsion + PSI_N) * step)
        if rolling:
            contact.psi_1 = take_one(rows, at + (roll + PSI_1) * step)
            contact.psi_2 = take_one(rows, at + (roll + PSI_2) * step)

    return kernel(unpack_spins, spec)


def make_visit_torsion(spec: Spec, eight: bool) -> Any:
    """Return `kernel(rows, at, pressed, ya, yb, most) -> (ya, yb, most)`.

    One projected update of psi_n of a contact, or of eight. pressed: lambda_n [N s].
    """
    take_number, take_axis = (take_eight, take_triples) if eight else (take_one, take_triple)
    put_number = put_eight if eight else put_one
    step, begin = WIDTH if eight else 1, begins(spec).torsion * (WIDTH if eight else 1)

    def visit_torsion(rows, at, pressed, ya, yb, most):
        at = at + begin
        a = take_axis(rows, at + TORSION_A * step)
        b = take_axis(rows, at + TORSION_B * step)
        spin = total(a * ya + b * yb) + take_number(rows, at + W_TORSION * step)
        old = take_number(rows, at + PSI_N * step)
        new = clamped(
            old - spin * take_number(rows, at + INV_TORSION * step),
            take_number(rows, at + C_TORSION * step) * pressed,
        )
        put_number(rows, at + PSI_N * step, new)
        change = new - old
        speed = magnitude(change) * take_number(rows, at + TORSION_SPEED * step)
        return ya + a * change, yb + b * change, greater(speed, most)

    return kernel(visit_torsion, spec)


def make_visit_roll(spec: Spec, eight: bool) -> Any:
    """Return the same of psi_1, psi_2."""
    take_number, take_axis = (take_eight, take_triples) if eight else (take_one, take_triple)
    put_number, project_disc = put_eight if eight else put_one, make_project_disc(spec)
    step, begin = WIDTH if eight else 1, begins(spec).roll * (WIDTH if eight else 1)

    def visit_roll(rows, at, pressed, ya, yb, most):
        at = at + begin
        a_1 = take_axis(rows, at + ROLL_A * step)
        a_2 = take_axis(rows, at + (ROLL_A + AXIS) * step)
        b_1 = take_axis(rows, at + ROLL_B * step)
        b_2 = take_axis(rows, at + (ROLL_B + AXIS) * step)
        w_1 = total(a_1 * ya + b_1 * yb) + take_number(rows, at + W_ROLL_1 * step)
        w_2 = total(a_2 * ya + b_2 * yb) + take_number(rows, at + W_ROLL_2 * step)
        old_1 = take_number(rows, at + PSI_1 * step)
        old_2 = take_number(rows, at + PSI_2 * step)
        h_12 = take_number(rows, at + H_12 * step)
        new_1 = old_1 - take_number(rows, at + H_11 * step) * w_1 - h_12 * w_2
        new_2 = old_2 - h_12 * w_1 - take_number(rows, at + H_22 * step) * w_2
        limit = take_number(rows, at + C_ROLL * step) * pressed
        stick, disc = new_1 * new_1 + new_2 * new_2, limit * limit
        if any_greater(stick, disc):
            inv_roll = take_number(rows, at + INV_ROLL * step)
            rolled_1, rolled_2 = project_disc(old_1 - w_1 * inv_roll, old_2 - w_2 * inv_roll, limit)
            new_1 = where_greater(stick, disc, rolled_1, new_1)
            new_2 = where_greater(stick, disc, rolled_2, new_2)
        put_number(rows, at + PSI_1 * step, new_1)
        put_number(rows, at + PSI_2 * step, new_2)
        change_1, change_2 = new_1 - old_1, new_2 - old_2
        largest = greater(magnitude(change_1), magnitude(change_2))
        speed = largest * take_number(rows, at + ROLL_SPEED * step)
        return (
            ya + (a_1 * change_1 + a_2 * change_2),
            yb + (b_1 * change_1 + b_2 * change_2),
            greater(speed, most),
        )

    return kernel(visit_roll, spec)
