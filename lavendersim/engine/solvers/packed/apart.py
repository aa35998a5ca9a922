"""Sweeps of positional projection over packed contacts: rows of a normal alone, eight at a time.

    push <- max(0, push + (correction - n . u) / k_n),    u follows it
with pseudo-velocities u of two bodies in their state, as `sweep` has velocities.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...spec import Spec
from ...team import PUSH as PUSH_TASK
from ..solver import ContactSystem
from .lane_memory import (
    put_bodies,
    put_eight,
    put_one,
    take_bodies,
    take_eight,
    take_triples,
)
from .lanes import WIDTH, greater, lane, magnitude, positive, total, zeros
from .layout import ARM_A, ARM_B, NORMAL, PER_MASS_A, PER_MASS_B
from .packing import make_pack_rows, make_put_arms, make_put_geometry, make_unpack_bodies
from .team_sweeps import make_share_sweep

# Fields of one number each, behind the masses of a normal alone.
CORRECTION, PER_K, PUSH = range(PER_MASS_B + 1, PER_MASS_B + 4)
PUSHED = PUSH + 1


def _make_pack_normal(spec: Spec) -> Any:
    (put_axis, _, _), put_arms = make_put_geometry(spec, True), make_put_arms(spec, True)

    def pack_normal(contact, velocities, rows, at, factor):
        put_axis(rows, at + NORMAL * WIDTH, contact.nx, contact.ny, contact.nz)
        put_arms(contact, factor, rows, at + ARM_A * WIDTH, at + ARM_B * WIDTH)
        put_one(rows, at + PER_MASS_A * WIDTH, contact.inv_m_a)
        put_one(rows, at + PER_MASS_B * WIDTH, contact.inv_m_b)
        put_one(rows, at + CORRECTION * WIDTH, contact.correction)
        put_one(rows, at + PER_K * WIDTH, contact.inv_k_n)
        put_one(rows, at + PUSH * WIDTH, contact.push)

    return kernel(pack_normal, spec)


def _make_visit_normals(spec: Spec) -> Any:
    """Return `kernel(packed, at, slot, own, most) -> most`, the greatest change of a push."""

    def visit_normals(packed, at, slot, own, most):
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
        put_bodies(state, first, slot, own, (va, ya + arm_a * change))
        put_bodies(state, second, slot, own, (vb, yb + arm_b * change))
        return greater(magnitude(change), most)

    return kernel(visit_normals, spec)


def make_push_groups(spec: Spec) -> Any:
    """Return `kernel(packed, first, last, own) -> greatest change` of a push [kg m]."""
    visit = _make_visit_normals(spec)

    def push_groups(packed, first, last, own):
        most = zeros()
        for g in range(first, last):
            most = visit(packed, g * PUSHED * WIDTH, g * WIDTH, own, most)
        greatest = lane(most, 0)
        for k in range(1, WIDTH):
            greatest = greater(lane(most, k), greatest)
        return greatest

    return kernel(push_groups, spec)


def make_push_apart(spec: Spec) -> Any:
    """Return `kernel(system, packed, pseudo, sweeps) -> sweeps made`.

    Set are a contact's `correction` [m], `push` [kg m] and `inv_k_n` [kg]; the pseudo-velocities
    [m], [rad] are 0. sweeps: at most. What contacts push is needed by nobody afterwards: it stays
    in the packed rows.
    """
    pack = make_pack_rows(spec, True, _make_pack_normal(spec), PUSHED)
    unpack_bodies = make_unpack_bodies(spec)
    push = make_share_sweep(spec, make_push_groups(spec), PUSH_TASK)

    def push_apart(system, packed, pseudo, sweeps):
        contacts, order, bodies = system.contacts, system.order, system.bodies
        slots = pack(ContactSystem(contacts, order, system.count, bodies, pseudo), packed)
        made = 0
        for _ in range(sweeps):
            made += 1
            if not push(packed, slots) > 0.0:  # nor would anything in the sweeps that are left
                break
        unpack_bodies(bodies, pseudo, packed)
        return made

    return kernel(push_apart, spec)
