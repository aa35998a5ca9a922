"""Contacts enter; what a sweep reads of them leaves, packed in the order in which it reads it.

A sweep over whole contact records fetches twice what it uses, from all over the table, and turns
every impulse into angular velocities by two 3x3 matrices. Packed, with I^-1 = L L^T per body,
    omega = omega_0 + L y,    (r x n) . omega = (r x n) . omega_0 + (L^T (r x n)) . y
three numbers of a body and an axis serve both ways: what y gives the row, and what an impulse gives
y. The state holds what the solve changes, v - v_0 and y; what v_0, omega_0 and targets give a row
is one number of it. Bodies that nothing moves have L = 0 and 1/m = 0: their state stays 0.

Numbers lie by groups of eight contacts, the eight of each field side by side. A group is a run of
consecutive contacts of the order. Where groups have to be free of shared bodies, one ends before
the first contact that shares a movable body with it, and is filled up with contacts of all 0.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from ..block import make_relative_velocity
from ..compile import inner, kernel
from ..effects.smooth_contact import has_smooth
from ..spec import Spec
from .lanes import STRIDE, WIDTH, put_one, take_one

# Where the eight numbers of a field begin within a group. Axes of the contact, x y z each:
AXIS = 3 * WIDTH
N, T1, T2 = range(0, 3 * AXIS, AXIS)
# L^T (r x axis) of body A, negative, and of body B, for the axes n, t1, t2.
TURN_A, TURN_B = 3 * AXIS, 6 * AXIS
# Fields of one number each. W_N, W_1, W_2: velocities without the solve's impulses, with targets.
(
    INV_M_A, INV_M_B, W_N, W_1, W_2, INV_K, K_N1, K_N2, I_11, I_12, I_22, INV_K_T, K_N, K_T, MU,
    GAMMA, LAMBDA_N, LAMBDA_1, LAMBDA_2,
) = range(9 * AXIS, 9 * AXIS + 19 * WIDTH, WIDTH)  # fmt: skip
GROUP = LAMBDA_2 + WIDTH  # numbers of a group
LINE = 64  # [bytes] of the processor's cache


class Packed(NamedTuple):
    """Arrays of one solve."""

    rows: np.ndarray  # (groups * GROUP,) the fields of every group
    first: np.ndarray  # (groups * WIDTH,) int64, where the state of body A begins
    second: np.ndarray  # the same of body B
    slot: np.ndarray  # (contacts,) int64, place of the contact visited k-th: 8 group + lane
    state: np.ndarray  # ((bodies + 1) * STRIDE,) v - v_0, y, 0, 0; the last for what fills up
    start: np.ndarray  # (bodies, 6) v_0, omega_0
    factor: np.ndarray  # (bodies, 6) L by rows: xx, yx, yy, zx, zy, zz
    group_of: np.ndarray  # (bodies,) int64, last group with a contact of the body


def allocate_packed(bodies: int, contacts: int, groups: int) -> Packed:
    """Return arrays for so many bodies, contacts and groups; memory is taken when it is used."""
    return Packed(
        _lines(groups * GROUP),
        np.zeros(groups * WIDTH, np.int64),
        np.zeros(groups * WIDTH, np.int64),
        np.zeros(contacts, np.int64),
        _lines((bodies + 1) * STRIDE),
        np.zeros((bodies, 6)),
        np.zeros((bodies, 6)),
        np.zeros(bodies, np.int64),
    )


def _lines(numbers: int) -> np.ndarray:
    """Return zeros that begin with a line of the processor's cache."""
    held = np.zeros(numbers + STRIDE)
    begin = -held.ctypes.data % LINE // held.itemsize
    return held[begin : begin + numbers]


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
    factor[0], factor[1], factor[2], factor[3], factor[4], factor[5] = xx, yx, yy, zx, zy, zz


@inner
def _put_axis(rows, at, x, y, z):
    put_one(rows, at, x)
    put_one(rows, at + WIDTH, y)
    put_one(rows, at + 2 * WIDTH, z)


@inner
def _put_turn(rows, at, factor, i, side, x, y, z):
    """Write side L^T (x, y, z) of body i."""
    _put_axis(
        rows,
        at,
        side * (factor[i, 0] * x + factor[i, 1] * y + factor[i, 3] * z),
        side * (factor[i, 2] * y + factor[i, 4] * z),
        side * (factor[i, 5] * z),
    )


@inner
def _put_turns(rows, at, factor, i, side, contact, rx, ry, rz):
    """Write side L^T (r x axis) of body i for n, t1, t2."""
    x, y, z = contact.nx, contact.ny, contact.nz
    _put_turn(rows, at, factor, i, side, ry * z - rz * y, rz * x - rx * z, rx * y - ry * x)
    x, y, z = contact.t1x, contact.t1y, contact.t1z
    at += AXIS
    _put_turn(rows, at, factor, i, side, ry * z - rz * y, rz * x - rx * z, rx * y - ry * x)
    x, y, z = contact.t2x, contact.t2y, contact.t2z
    at += AXIS
    _put_turn(rows, at, factor, i, side, ry * z - rz * y, rz * x - rx * z, rx * y - ry * x)


def _make_pack_contact(spec: Spec) -> Any:
    """Return `kernel(contact, velocities, rows, at, factor)`: every field of a contact."""
    compliant, smooth = spec.has("compliance"), has_smooth(spec)
    moving_surface = spec.has("surface_velocity")
    relative_velocity = make_relative_velocity(spec)

    def pack_contact(contact, velocities, rows, at, factor):
        a, b = contact.a, contact.b
        _put_axis(rows, at + N, contact.nx, contact.ny, contact.nz)
        _put_axis(rows, at + T1, contact.t1x, contact.t1y, contact.t1z)
        _put_axis(rows, at + T2, contact.t2x, contact.t2y, contact.t2z)
        _put_turns(
            rows, at + TURN_A, factor, a, -1.0, contact, contact.rax, contact.ray, contact.raz
        )
        _put_turns(
            rows, at + TURN_B, factor, b, 1.0, contact, contact.rbx, contact.rby, contact.rbz
        )
        put_one(rows, at + INV_M_A, contact.inv_m_a)
        put_one(rows, at + INV_M_B, contact.inv_m_b)
        x, y, z = relative_velocity(contact, velocities[a], velocities[b])
        w_n = contact.nx * x + contact.ny * y + contact.nz * z + contact.target
        w_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        w_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        if moving_surface:
            w_1 += contact.surface_1
            w_2 += contact.surface_2
        put_one(rows, at + W_N, w_n)
        put_one(rows, at + W_1, w_1)
        put_one(rows, at + W_2, w_2)
        put_one(rows, at + INV_K, contact.inv_k)
        put_one(rows, at + K_N1, contact.k_n1)
        put_one(rows, at + K_N2, contact.k_n2)
        put_one(rows, at + I_11, contact.i_11)
        put_one(rows, at + I_12, contact.i_12)
        put_one(rows, at + I_22, contact.i_22)
        put_one(rows, at + INV_K_T, 1.0 / contact.k_t)
        put_one(rows, at + K_N, contact.k_n)
        put_one(rows, at + K_T, contact.k_t)
        put_one(rows, at + MU, contact.mu)
        if compliant:
            put_one(rows, at + GAMMA, contact.gamma)
        put_one(rows, at + LAMBDA_N, contact.lambda_n)
        put_one(rows, at + LAMBDA_1, contact.lambda_1)
        put_one(rows, at + LAMBDA_2, contact.lambda_2)
        if smooth:
            if contact.rough == 0:
                # It has a normal alone, and levers that leave out round-off: no answer across.
                put_one(rows, at + I_11, 0.0)
                put_one(rows, at + I_12, 0.0)
                put_one(rows, at + I_22, 0.0)
                x, y, z = contact.lever_ax, contact.lever_ay, contact.lever_az
                _put_turn(rows, at + TURN_A, factor, a, -1.0, x, y, z)
                x, y, z = contact.lever_bx, contact.lever_by, contact.lever_bz
                _put_turn(rows, at + TURN_B, factor, b, 1.0, x, y, z)

    return kernel(pack_contact, spec)


def make_pack(spec: Spec, apart: bool) -> Any:
    """Return `kernel(contacts, order, count, bodies, velocities, packed) -> groups`.

    apart: no two contacts of a group share a movable body.
    """
    pack_contact = _make_pack_contact(spec)

    def pack_bodies(bodies, velocities, packed):
        for i in range(bodies.shape[0]):
            v, start = velocities[i], packed.start
            start[i, 0], start[i, 1], start[i, 2] = v.vx, v.vy, v.vz
            start[i, 3], start[i, 4], start[i, 5] = v.wx, v.wy, v.wz
            for k in range(6):
                packed.factor[i, k] = 0.0
            if bodies[i].inv_m > 0.0:
                _factorise(v, packed.factor[i])
            packed.group_of[i] = -1
            for k in range(STRIDE):
                packed.state[i * STRIDE + k] = 0.0

    pack_bodies = kernel(pack_bodies, spec)

    def fill_up(packed, begin, end, spare):
        for slot in range(begin, end):
            at = slot // WIDTH * GROUP + slot % WIDTH
            for field in range(0, GROUP, WIDTH):
                put_one(packed.rows, at + field, 0.0)
            packed.first[slot], packed.second[slot] = spare, spare

    fill_up = kernel(fill_up, spec)

    def pack(contacts, order, count, bodies, velocities, packed):
        pack_bodies(bodies, velocities, packed)
        spare = bodies.shape[0] * STRIDE
        slot = 0
        for k in range(count):
            contact = contacts[order[k]]
            a, b = contact.a, contact.b
            if apart:
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
            at = slot // WIDTH * GROUP + slot % WIDTH
            pack_contact(contact, velocities, packed.rows, at, packed.factor)
            slot += 1
        groups = (slot + WIDTH - 1) // WIDTH
        fill_up(packed, slot, groups * WIDTH, spare)
        return groups

    return kernel(pack, spec)


def make_unpack(spec: Spec) -> Any:
    """Return `kernel(contacts, order, count, bodies, velocities, packed)`: as the sweeps left them.

    Impulses and velocities of the records; what is packed stays as it is.
    """

    def unpack(contacts, order, count, bodies, velocities, packed):
        for k in range(count):
            contact, slot = contacts[order[k]], packed.slot[k]
            at = slot // WIDTH * GROUP + slot % WIDTH
            contact.lambda_n = take_one(packed.rows, at + LAMBDA_N)
            contact.lambda_1 = take_one(packed.rows, at + LAMBDA_1)
            contact.lambda_2 = take_one(packed.rows, at + LAMBDA_2)
        for i in range(bodies.shape[0]):
            if bodies[i].inv_m > 0.0:
                v, at, start, factor = velocities[i], i * STRIDE, packed.start, packed.factor
                v.vx = start[i, 0] + take_one(packed.state, at)
                v.vy = start[i, 1] + take_one(packed.state, at + 1)
                v.vz = start[i, 2] + take_one(packed.state, at + 2)
                x = take_one(packed.state, at + 3)
                y = take_one(packed.state, at + 4)
                z = take_one(packed.state, at + 5)
                v.wx = start[i, 3] + factor[i, 0] * x
                v.wy = start[i, 4] + factor[i, 1] * x + factor[i, 2] * y
                v.wz = start[i, 5] + factor[i, 3] * x + factor[i, 4] * y + factor[i, 5] * z

    return kernel(unpack, spec)
