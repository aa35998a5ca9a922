"""Packing contacts and bodies for a solve (`layout`), and back when its sweeps are done."""

from __future__ import annotations

from math import sqrt
from typing import Any

from ...compile import inner, kernel
from ...prefetch import AHEAD, make_prefetch_span, prefetch_impulses
from ...rotation import inverse_inertia_times
from ...row_terms import row_terms
from ...spec import Spec
from ...team import MEMBERS
from ...vectors import Vec3, cross, dot, plus_scaled
from .lane_memory import STRIDE, put_one, take_one
from .lanes import WIDTH
from .layout import AXIS, HEAD, RUN, make_place
from .team_sweeps import make_find_stages

# The first and the last field of a record that packing may read (`record_layout.READ_BY_ALL`).
PACKED = "a", "inv_k", "lambda_2", "inv_k_n"


@inner
def _factorise(factor, first, second, third):
    """L of a body's world inverse inertia, I^-1 = L L^T, by columns; 0 where a pivot is."""
    xx = sqrt(first.x)
    inverse = 1.0 / xx if xx > 0.0 else 0.0
    yx, zx = first.y * inverse, first.z * inverse
    yy = sqrt(max(second.y - yx * yx, 0.0))
    inverse = 1.0 / yy if yy > 0.0 else 0.0
    zy = (second.z - zx * yx) * inverse
    zz = sqrt(max(third.z - zx * zx - zy * zy, 0.0))
    factor.xx, factor.yx, factor.yy = xx, yx, yy
    factor.zx, factor.zy, factor.zz = zx, zy, zz


def make_put_geometry(spec: Spec, eight: bool) -> Any:
    """Return kernels that write an axis, a turn of a body, and one side of the turns."""
    step, coupled = WIDTH if eight else 1, row_terms(spec).coupled

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
        one, two = cross(r, t1), cross(r, t2)
        if coupled:
            e = Vec3(contact.patch_x, contact.patch_y, contact.patch_z)
            one, two = plus_scaled(one, dot(e, t1), n), plus_scaled(two, dot(e, t2), n)
        put_turn(rows, at, own, side, cross(r, n))
        put_turn(rows, at + AXIS * step, own, side, one)
        put_turn(rows, at + 2 * AXIS * step, own, side, two)

    return put_axis, put_turn, kernel(put_turns, spec)


def make_put(spec: Spec, eight: bool) -> Any:
    """Return `kernel(rows, at, field, value)`."""
    step = WIDTH if eight else 1

    def put(rows, at, field, value):
        put_one(rows, at + field * step, value)

    return kernel(put, spec)


def make_put_arms(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, factor, rows, arm_a, arm_b)`: turns about a normal alone.

    arm_a, arm_b: where those of body A, negative, and of body B begin.
    """
    terms = row_terms(spec)
    frictional, frictionless, levers = terms.frictional, terms.frictionless, terms.levers
    put_axis, put_turn, _ = make_put_geometry(spec, eight)

    def put_arms(contact, factor, rows, arm_a, arm_b):
        if not levers:
            put_axis(rows, arm_a, 0.0, 0.0, 0.0)
            put_axis(rows, arm_b, 0.0, 0.0, 0.0)
            return
        lever_a, lever_b = Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)
        alone = not frictional
        if frictional:
            if frictionless:
                alone = contact.frictional == 0
            n = Vec3(contact.nx, contact.ny, contact.nz)
            lever_a = cross(Vec3(contact.rax, contact.ray, contact.raz), n)
            lever_b = cross(Vec3(contact.rbx, contact.rby, contact.rbz), n)
        if frictionless:
            if alone:  # its levers leave out round-off
                lever_a = Vec3(contact.lever_ax, contact.lever_ay, contact.lever_az)
                lever_b = Vec3(contact.lever_bx, contact.lever_by, contact.lever_bz)
        put_turn(rows, arm_a, factor[contact.a], -1.0, lever_a)
        put_turn(rows, arm_b, factor[contact.b], 1.0, lever_b)

    return kernel(put_arms, spec)


def _make_pack_bodies(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, packed)`: what the solve begins with."""
    terms = row_terms(spec)
    turns, refreshed = terms.levers, terms.frictional

    def pack_bodies(bodies, velocities, packed):
        for i in range(bodies.shape[0]):
            v, start, factor = velocities[i], packed.start[i], packed.factor[i]
            start.vx, start.vy, start.vz = v.vx, v.vy, v.vz
            factor.xx, factor.yx, factor.yy = 0.0, 0.0, 0.0
            factor.zx, factor.zy, factor.zz = 0.0, 0.0, 0.0
            if turns:
                start.wx, start.wy, start.wz = v.wx, v.wy, v.wz
                if bodies[i].inv_m > 0.0:
                    if refreshed:
                        _factorise(
                            factor,
                            Vec3(v.jxx, v.jxy, v.jxz),
                            Vec3(v.jxy, v.jyy, v.jyz),
                            Vec3(v.jxz, v.jyz, v.jzz),
                        )
                    else:
                        x, y, z = inverse_inertia_times(bodies[i], 1.0, 0.0, 0.0)
                        first = Vec3(x, y, z)
                        x, y, z = inverse_inertia_times(bodies[i], 0.0, 1.0, 0.0)
                        second = Vec3(x, y, z)
                        x, y, z = inverse_inertia_times(bodies[i], 0.0, 0.0, 1.0)
                        _factorise(factor, first, second, Vec3(x, y, z))
            packed.group_of[i] = -1
            for k in range(STRIDE):
                packed.state[(HEAD + i) * STRIDE + k] = 0.0
        for k in range(STRIDE):
            packed.state[k] = 0.0

    return kernel(pack_bodies, spec)


def make_pack_rows(spec: Spec, eight: bool, pack_contact: Any, fields: int) -> Any:
    """Return `kernel(system, packed) -> slots`, for rows of so many fields.

    pack_contact: kernel(contact, velocities, rows, at, factor), writes the fields of one.
    """
    pack_bodies = _make_pack_bodies(spec)
    prefetch = make_prefetch_span(PACKED)
    place = make_place(spec, eight, fields)

    def fill(packed, begin, end):
        for slot in range(begin, end):
            at = place(slot)
            for field in range(fields):
                put_one(packed.rows, at + field * WIDTH, 0.0)
            packed.first[slot], packed.second[slot] = 0, 0

    fill_up: Any = kernel(fill, spec) if eight else None
    find_stages: Any = make_find_stages(spec) if eight else None

    def note_run(packed, body, run):
        # Before the body's last group is set; what has no mass is in all of them.
        if packed.group_of[body] < 0:
            packed.run_of[body] = run
        packed.reach[0] = max(packed.reach[0], run - packed.run_of[body])

    note_run = kernel(note_run, spec)

    def pack(system, packed):
        contacts, order, bodies = system.contacts, system.order, system.bodies
        velocities = system.velocities
        pack_bodies(bodies, velocities, packed)
        slot = 0
        packed.reach[0] = 0
        for k in range(system.count):
            prefetch(contacts, order[min(k + AHEAD, system.count - 1)])
            contact = contacts[order[k]]
            a, b = contact.a, contact.b
            if eight:
                group = slot // WIDTH
                shares = contact.inv_m_a > 0.0 and packed.group_of[a] == group
                shares = shares or (contact.inv_m_b > 0.0 and packed.group_of[b] == group)
                if shares:
                    group += 1
                    fill_up(packed, slot, group * WIDTH)
                    slot = group * WIDTH
                if contact.inv_m_a > 0.0:
                    note_run(packed, a, group // RUN)
                if contact.inv_m_b > 0.0:
                    note_run(packed, b, group // RUN)
                packed.group_of[a], packed.group_of[b] = group, group
            packed.slot[k] = slot
            packed.first[slot] = (HEAD + a) * STRIDE if contact.inv_m_a > 0.0 else 0
            packed.second[slot] = (HEAD + b) * STRIDE if contact.inv_m_b > 0.0 else 0
            pack_contact(contact, velocities, packed.rows, place(slot), packed.factor)
            slot += 1
        if eight:
            end = (slot + WIDTH - 1) // WIDTH * WIDTH
            fill_up(packed, slot, end)
            slot = end
            packed.counts[0] = 0
            if packed.team.words[MEMBERS] > 0:
                find_stages(packed, slot)
        return slot

    return kernel(pack, spec)


def make_unpack_rows(spec: Spec, eight: bool, unpack_contact: Any, fields: int) -> Any:
    """Return `kernel(system, packed)`: as the sweeps left them, for rows of so many fields.

    Impulses and velocities of the records; what is packed stays as it is.
    unpack_contact: kernel(contact, rows, at), reads the impulses of one.
    """
    place, unpack_bodies = make_place(spec, eight, fields), make_unpack_bodies(spec)

    def unpack(system, packed):
        contacts, order = system.contacts, system.order
        for k in range(system.count):
            prefetch_impulses(contacts, order[min(k + AHEAD, system.count - 1)])
            unpack_contact(contacts[order[k]], packed.rows, place(packed.slot[k]))
        unpack_bodies(system.bodies, system.velocities, packed)

    return kernel(unpack, spec)


def make_unpack_bodies(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, packed)`: velocities of what moves."""
    turns = row_terms(spec).levers

    def unpack_bodies(bodies, velocities, packed):
        for i in range(bodies.shape[0]):
            if bodies[i].inv_m > 0.0:
                v, at = velocities[i], (HEAD + i) * STRIDE
                start, own = packed.start[i], packed.factor[i]
                v.vx = start.vx + take_one(packed.state, at)
                v.vy = start.vy + take_one(packed.state, at + 1)
                v.vz = start.vz + take_one(packed.state, at + 2)
                if turns:
                    x = take_one(packed.state, at + 4)
                    y = take_one(packed.state, at + 5)
                    z = take_one(packed.state, at + 6)
                    v.wx = start.wx + own.xx * x
                    v.wy = start.wy + own.yx * x + own.yy * y
                    v.wz = start.wz + own.zx * x + own.zy * y + own.zz * z

    return kernel(unpack_bodies, spec)
