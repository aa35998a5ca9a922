"""Packing contacts and bodies for a solve (`layout`), and back when its sweeps are done."""

from __future__ import annotations

from math import sqrt
from typing import Any

from ...block import make_slip_velocity
from ...compile import inner, kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...vectors import Vec3, cross
from .lane_memory import STRIDE, put_one, take_one
from .lanes import WIDTH
from .layout import (
    AXIS,
    FIELDS,
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
    N,
    make_place,
)


@inner
def _factorise(v, factor):
    """L of a body's world inverse inertia, I^-1 = L L^T; 0 where a pivot is."""
    xx = sqrt(v.jxx)
    inverse = 1.0 / xx if xx > 0.0 else 0.0
    yx, zx = v.jxy * inverse, v.jxz * inverse
    yy = sqrt(max(v.jyy - yx * yx, 0.0))
    inverse = 1.0 / yy if yy > 0.0 else 0.0
    zy = (v.jyz - zx * yx) * inverse
    zz = sqrt(max(v.jzz - zx * zx - zy * zy, 0.0))
    factor.xx, factor.yx, factor.yy = xx, yx, yy
    factor.zx, factor.zy, factor.zz = zx, zy, zz


def make_put_geometry(spec: Spec, eight: bool) -> Any:
    """Return kernels that write an axis, a turn of a body, and one side of the turns."""
    step = WIDTH if eight else 1

    def put_axis(rows, at, x, y, z):
        put_one(rows, at, x)
        put_one(rows, at + step, y)
        put_one(rows, at + 2 * step, z)

    put_axis = kernel(put_axis, spec)

    def put_turn(rows, at, own, side, arm):
        # side L^T arm of a body whose factor is `own`
        put_axis(
            rows,
            at,
            side * (own.xx * arm.x + own.yx * arm.y + own.zx * arm.z),
            side * (own.yy * arm.y + own.zy * arm.z),
            side * (own.zz * arm.z),
        )

    put_turn = kernel(put_turn, spec)

    def put_turns(rows, at, own, side, contact, r):
        # side L^T (r x axis) of that body for n, t1, t2
        n = Vec3(contact.nx, contact.ny, contact.nz)
        t1 = Vec3(contact.t1x, contact.t1y, contact.t1z)
        t2 = Vec3(contact.t2x, contact.t2y, contact.t2z)
        put_turn(rows, at, own, side, cross(r, n))
        put_turn(rows, at + AXIS * step, own, side, cross(r, t1))
        put_turn(rows, at + 2 * AXIS * step, own, side, cross(r, t2))

    return put_axis, put_turn, kernel(put_turns, spec)


def _make_pack_contact(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, velocities, rows, at, factor)`: every field of a contact."""
    terms = row_terms(spec)
    compliant, frictionless = terms.compliant, terms.frictionless
    slip_velocity = make_slip_velocity(spec)
    put_axis, put_turn, put_turns = make_put_geometry(spec, eight)
    step = WIDTH if eight else 1

    def put(rows, at, field, value):
        put_one(rows, at + field * step, value)

    put = kernel(put, spec)

    def pack_contact(contact, velocities, rows, at, factor):
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
                # It has a normal alone, and levers that leave out round-off: no impulse across.
                put(rows, at, I_11, 0.0)
                put(rows, at, I_12, 0.0)
                put(rows, at, I_22, 0.0)
                lever_a = Vec3(contact.lever_ax, contact.lever_ay, contact.lever_az)
                lever_b = Vec3(contact.lever_bx, contact.lever_by, contact.lever_bz)
                put_turn(rows, turn_a, factor[a], -1.0, lever_a)
                put_turn(rows, turn_b, factor[b], 1.0, lever_b)

    return kernel(pack_contact, spec)


def _make_pack_bodies(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, packed)`: what the solve begins with."""

    def pack_bodies(bodies, velocities, packed):
        for i in range(bodies.shape[0]):
            v, start, factor = velocities[i], packed.start[i], packed.factor[i]
            start.vx, start.vy, start.vz = v.vx, v.vy, v.vz
            start.wx, start.wy, start.wz = v.wx, v.wy, v.wz
            factor.xx, factor.yx, factor.yy = 0.0, 0.0, 0.0
            factor.zx, factor.zy, factor.zz = 0.0, 0.0, 0.0
            if bodies[i].inv_m > 0.0:
                _factorise(v, factor)
            packed.group_of[i] = -1
            for k in range(STRIDE):
                packed.state[i * STRIDE + k] = 0.0

    return kernel(pack_bodies, spec)


def make_pack(spec: Spec, eight: bool) -> Any:
    """Return `kernel(system, packed) -> slots`."""
    return make_pack_rows(spec, eight, _make_pack_contact(spec, eight), FIELDS)


def make_pack_rows(spec: Spec, eight: bool, pack_contact: Any, fields: int) -> Any:
    """Return `kernel(system, packed) -> slots`, for rows of so many fields.

    pack_contact: kernel(contact, velocities, rows, at, factor), writes the fields of one.
    """
    pack_bodies = _make_pack_bodies(spec)
    place = make_place(spec, eight, fields)

    def fill(packed, begin, end, spare):
        for slot in range(begin, end):
            at = place(slot)
            for field in range(fields):
                put_one(packed.rows, at + field * WIDTH, 0.0)
            packed.first[slot], packed.second[slot] = spare, spare

    fill_up: Any = kernel(fill, spec) if eight else None

    def pack(system, packed):
        contacts, order, bodies = system.contacts, system.order, system.bodies
        velocities = system.velocities
        pack_bodies(bodies, velocities, packed)
        spare = bodies.shape[0] * STRIDE
        slot = 0
        for k in range(system.count):
            contact = contacts[order[k]]
            a, b = contact.a, contact.b
            if eight:
                group = slot // WIDTH
                shares = contact.inv_m_a > 0.0 and packed.group_of[a] == group
                shares = shares or (contact.inv_m_b > 0.0 and packed.group_of[b] == group)
                if shares:
                    group += 1
                    fill_up(packed, slot, group * WIDTH, spare)
                    slot = group * WIDTH
                packed.group_of[a], packed.group_of[b] = group, group
            packed.slot[k] = slot
            packed.first[slot], packed.second[slot] = a * STRIDE, b * STRIDE
            pack_contact(contact, velocities, packed.rows, place(slot), packed.factor)
            slot += 1
        if eight:
            end = (slot + WIDTH - 1) // WIDTH * WIDTH
            fill_up(packed, slot, end, spare)
            slot = end
        return slot

    return kernel(pack, spec)


def make_unpack(spec: Spec, eight: bool) -> Any:
    """Return `kernel(system, packed)`: as the sweeps left them.

    Impulses and velocities of the records; what is packed stays as it is.
    """
    place, step = make_place(spec, eight, FIELDS), WIDTH if eight else 1
    unpack_bodies = make_unpack_bodies(spec)

    def unpack(system, packed):
        contacts, order = system.contacts, system.order
        for k in range(system.count):
            contact, at = contacts[order[k]], place(packed.slot[k])
            contact.lambda_n = take_one(packed.rows, at + LAMBDA_N * step)
            contact.lambda_1 = take_one(packed.rows, at + LAMBDA_1 * step)
            contact.lambda_2 = take_one(packed.rows, at + LAMBDA_2 * step)
        unpack_bodies(system.bodies, system.velocities, packed)

    return kernel(unpack, spec)


def make_unpack_bodies(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, packed)`: velocities of what moves."""

    def unpack_bodies(bodies, velocities, packed):
        for i in range(bodies.shape[0]):
            if bodies[i].inv_m > 0.0:
                v, at, start, own = velocities[i], i * STRIDE, packed.start[i], packed.factor[i]
                v.vx = start.vx + take_one(packed.state, at)
                v.vy = start.vy + take_one(packed.state, at + 1)
                v.vz = start.vz + take_one(packed.state, at + 2)
                x = take_one(packed.state, at + 4)
                y = take_one(packed.state, at + 5)
                z = take_one(packed.state, at + 6)
                v.wx = start.wx + own.xx * x
                v.wy = start.wy + own.yx * x + own.yy * y
                v.wz = start.wz + own.zx * x + own.zy * y + own.zz * z

    return kernel(unpack_bodies, spec)
