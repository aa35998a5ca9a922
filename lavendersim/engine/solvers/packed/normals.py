"""Packed contacts of scenes without friction: rows of a normal alone, one at a time or eight.

    w = n . (v_B - v_A) + J y + b + gamma lambda,    lambda <- max(0, lambda - w / (k_n + gamma))
    v_A -= n p / m_A,   v_B += n p / m_B,   y += J^T p,   p: the change of lambda
Where no normal misses a centre of mass, nothing turns and J is left out.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...contact import make_frictionless_velocity
from ...row_terms import row_terms
from ...spec import Spec
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
from .lanes import WIDTH, greater, magnitude, positive, total
from .layout import (
    ARM_A,
    ARM_B,
    INV_K_NORMAL,
    K_NORMAL,
    NORMAL,
    PER_MASS_A,
    PER_MASS_B,
    PRESSED,
    SOFT,
    W_NORMAL,
)
from .packing import make_put, make_put_arms, make_put_geometry


def make_pack_normal(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, velocities, rows, at, factor)`: every field of a normal."""
    compliant, normal_velocity = row_terms(spec).compliant, make_frictionless_velocity(spec)
    put, put_arms = make_put(spec, eight), make_put_arms(spec, eight)
    put_axis, _, _ = make_put_geometry(spec, eight)
    step = WIDTH if eight else 1

    def pack_normal(contact, velocities, rows, at, factor):
        put_axis(rows, at + NORMAL * step, contact.nx, contact.ny, contact.nz)
        put_arms(contact, factor, rows, at + ARM_A * step, at + ARM_B * step)
        put(rows, at, PER_MASS_A, contact.inv_m_a)
        put(rows, at, PER_MASS_B, contact.inv_m_b)
        v_n = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
        put(rows, at, W_NORMAL, v_n + contact.target)
        put(rows, at, INV_K_NORMAL, contact.inv_k)
        put(rows, at, K_NORMAL, contact.k_n)
        if compliant:
            put(rows, at, SOFT, contact.gamma)
        put(rows, at, PRESSED, contact.lambda_n)

    return kernel(pack_normal, spec)


def make_unpack_normal(spec: Spec, eight: bool) -> Any:
    """Return `kernel(contact, rows, at)`: its impulse."""
    step = WIDTH if eight else 1

    def unpack_normal(contact, rows, at):
        contact.lambda_n = take_one(rows, at + PRESSED * step)

    return kernel(unpack_normal, spec)


def make_visit_normal(spec: Spec, eight: bool) -> Any:
    """Return `kernel(packed, at, slot, own, most) -> most`, see `sweep`."""
    compliant, levers = row_terms(spec).compliant, row_terms(spec).levers
    step = WIDTH if eight else 1
    take_number, take_axis = (take_eight, take_triples) if eight else (take_one, take_triple)
    put_number = put_eight if eight else put_one
    take_state, put_state = (take_bodies, put_bodies) if eight else (take_body, put_body)

    def visit_normal(packed, at, slot, own, most):
        rows, state, first, second = packed.rows, packed.state, packed.first, packed.second
        va, ya = take_state(state, first, slot)
        vb, yb = take_state(state, second, slot)
        n = take_axis(rows, at + NORMAL * step)
        along = n * (vb - va)
        if levers:
            arm_a = take_axis(rows, at + ARM_A * step)
            arm_b = take_axis(rows, at + ARM_B * step)
            along = along + arm_a * ya + arm_b * yb
        w = total(along) + take_number(rows, at + W_NORMAL * step)
        old = take_number(rows, at + PRESSED * step)
        if compliant:
            w = w + take_number(rows, at + SOFT * step) * old
        new = positive(old - w * take_number(rows, at + INV_K_NORMAL * step))
        put_number(rows, at + PRESSED * step, new)
        change = new - old
        p = n * change
        va = va - p * take_number(rows, at + PER_MASS_A * step)
        vb = vb + p * take_number(rows, at + PER_MASS_B * step)
        if levers:
            ya = ya + arm_a * change
            yb = yb + arm_b * change
        put_state(state, first, slot, own, (va, ya))
        put_state(state, second, slot, own, (vb, yb))
        return greater(magnitude(change) * take_number(rows, at + K_NORMAL * step), most)

    return kernel(visit_normal, spec)
