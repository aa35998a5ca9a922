"""Sweeps of positional projection over packed contacts: rows of a normal alone, eight at a time.

    push <- max(0, push + (correction - n . u) / k_n),    u follows it
with pseudo-velocities u of two bodies in their state, as `sweep` has velocities.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...vectors import Vec3, cross
from ..solver import ContactSystem
from .lane_memory import (
    put_bodies,
    put_eight,
    put_one,
    take_bodies,
    take_eight,
    take_one,
    take_triples,
)
from .lanes import WIDTH, greater, lane, magnitude, positive, total, zeros
from .layout import AXIS, make_place
from .packing import make_pack_rows, make_put_geometry, make_unpack_bodies

# Fields, in numbers: the normal, what each body does about it, and one number each.
NORMAL, ARM_A, ARM_B = range(0, 3 * AXIS, AXIS)
PER_MASS_A, PER_MASS_B, CORRECTION, PER_K, PUSH = range(3 * AXIS, 3 * AXIS + 5)
PUSHED = PUSH + 1


def _make_pack_normal(spec: Spec) -> Any:
    frictionless = row_terms(spec).frictionless
    put_axis, put_turn, _ = make_put_geometry(spec, True)

    def pack_normal(contact, velocities, rows, at, factor):
        put_axis(rows, at + NORMAL * WIDTH, contact.nx, contact.ny, contact.nz)
        n = Vec3(contact.nx, contact.ny, contact.nz)
        lever_a = cross(Vec3(contact.rax, contact.ray, contact.raz), n)
        lever_b = cross(Vec3(contact.rbx, contact.rby, contact.rbz), n)
        if frictionless:
            if contact.frictional == 0:
                lever_a = Vec3(contact.lever_ax, contact.lever_ay, contact.lever_az)
                lever_b = Vec3(contact.lever_bx, contact.lever_by, contact.lever_bz)
        put_turn(rows, at + ARM_A * WIDTH, factor[contact.a], -1.0, lever_a)
        put_turn(rows, at + ARM_B * WIDTH, factor[contact.b], 1.0, lever_b)
        put_one(rows, at + PER_MASS_A * WIDTH, contact.inv_m_a)
        put_one(rows, at + PER_MASS_B * WIDTH, contact.inv_m_b)
        put_one(rows, at + CORRECTION * WIDTH, contact.correction)
        put_one(rows, at + PER_K * WIDTH, contact.inv_k_n)
        put_one(rows, at + PUSH * WIDTH, contact.push)

    return kernel(pack_normal, spec)


def _make_visit_normals(spec: Spec) -> Any:
    """Return `kernel(packed, at, slot, most) -> most`, the greatest change of a push so far."""

    def visit_normals(packed, at, slot, most):
        rows, state, first, second = packed.rows, packed.state, packed.first, packed.second
        va, ya = take_bodies(state, first, slot)
        vb, yb = take_bodies(state, second, slot)
        n = take_triples(rows, at + NORMAL * WIDTH)
        arm_a = take_triples(rows, at + ARM_A * WIDTH)
        arm_b = take_triples(rows, at + ARM_B * WIDTH)
        moved = total(n * (vb - va) + arm_a * ya + arm_b * yb)
        old = take_eight(rows, at + PUSH * WIDTH)
        missing = take_eight(rows, at + CORRECTION * WIDTH) - moved
        push = positive(old + missing * take_eight(rows, at + PER_K * WIDTH))
        put_eight(rows, at + PUSH * WIDTH, push)
        change = push - old
        p = n * change
        va = va - p * take_eight(rows, at + PER_MASS_A * WIDTH)
        vb = vb + p * take_eight(rows, at + PER_MASS_B * WIDTH)
        put_bodies(state, first, slot, va, ya + arm_a * change)
        put_bodies(state, second, slot, vb, yb + arm_b * change)
        return greater(magnitude(change), most)

    return kernel(visit_normals, spec)


def make_push_apart(spec: Spec) -> Any:
    """Return `kernel(system, packed, pseudo, sweeps) -> sweeps made`.

    Set are a contact's `correction` [m], `push` [kg m] and `inv_k_n` [kg]; the pseudo-velocities
    [m], [rad] are 0. sweeps: at most.
    """
    pack = make_pack_rows(spec, True, _make_pack_normal(spec), PUSHED)
    unpack_bodies, visit = make_unpack_bodies(spec), _make_visit_normals(spec)
    place = make_place(spec, True, PUSHED)

    def push_apart(system, packed, pseudo, sweeps):
        contacts, order, bodies = system.contacts, system.order, system.bodies
        slots = pack(ContactSystem(contacts, order, system.count, bodies, pseudo), packed)
        made = 0
        for _ in range(sweeps):
            most = zeros()
            for g in range(slots // WIDTH):
                most = visit(packed, g * PUSHED * WIDTH, g * WIDTH, most)
            made += 1
            changed = False
            for k in range(WIDTH):
                changed = changed or lane(most, k) > 0.0
            if not changed:  # nor would anything in the sweeps that are left
                break
        for k in range(system.count):
            push = take_one(packed.rows, place(packed.slot[k]) + PUSH * WIDTH)
            contacts[order[k]].push = push
        unpack_bodies(bodies, pseudo, packed)
        return made

    return kernel(push_apart, spec)
