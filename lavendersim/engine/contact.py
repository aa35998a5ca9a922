"""A manifold point enters, a solver row leaves: frame, effective mass, and what is captured once.

    k_n = 1/m_A + 1/m_B + n . [(I_A^-1 (r_A x n)) x r_A + (I_B^-1 (r_B x n)) x r_B]
        = 1/m_A + 1/m_B + (r_A x n) . I_A^-1 (r_A x n) + (r_B x n) . I_B^-1 (r_B x n)

The restitution target belongs here and nowhere else: it is captured from the velocity before the
solve. Taken inside the sweeps it would erase the bounce after the first sweep.
"""

from __future__ import annotations

import numba

from .compile import OPTIONS, kernel
from .rotation import inverse_inertia_times
from .spec import Spec


@numba.njit(**OPTIONS)
def add_levers(contact, body_a, body_b):
    """Fill the angular parts of a row; returns what they add to k_n [1/kg]."""
    nx, ny, nz = contact.nx, contact.ny, contact.nz
    rx, ry, rz = contact.x - body_a.x, contact.y - body_a.y, contact.z - body_a.z
    lx, ly, lz = ry * nz - rz * ny, rz * nx - rx * nz, rx * ny - ry * nx
    tx, ty, tz = inverse_inertia_times(body_a, lx, ly, lz)
    contact.lever_ax, contact.lever_ay, contact.lever_az = lx, ly, lz
    contact.turn_ax, contact.turn_ay, contact.turn_az = tx, ty, tz
    k = lx * tx + ly * ty + lz * tz
    rx, ry, rz = contact.x - body_b.x, contact.y - body_b.y, contact.z - body_b.z
    lx, ly, lz = ry * nz - rz * ny, rz * nx - rx * nz, rx * ny - ry * nx
    tx, ty, tz = inverse_inertia_times(body_b, lx, ly, lz)
    contact.lever_bx, contact.lever_by, contact.lever_bz = lx, ly, lz
    contact.turn_bx, contact.turn_by, contact.turn_bz = tx, ty, tz
    return k + lx * tx + ly * ty + lz * tz


def make_normal_velocity(spec: Spec):
    """Return `kernel(contact, va, vb) -> v_n`, the velocity of B relative to A along n [m/s]."""
    torque = spec.has("contact_torque")

    def normal_velocity(contact, va, vb):
        v_n = (
            contact.nx * (vb.vx - va.vx)
            + contact.ny * (vb.vy - va.vy)
            + contact.nz * (vb.vz - va.vz)
        )
        if torque:
            v_n += (
                contact.lever_bx * vb.wx
                + contact.lever_by * vb.wy
                + contact.lever_bz * vb.wz
                - contact.lever_ax * va.wx
                - contact.lever_ay * va.wy
                - contact.lever_az * va.wz
            )
        return v_n

    return kernel(normal_velocity, spec)


def make_apply_impulse(spec: Spec):
    """Return `kernel(contact, va, vb, impulse)`: + on B, - on A, along n [N s]."""
    torque = spec.has("contact_torque")

    def apply_impulse(contact, va, vb, impulse):
        pa, pb = impulse * contact.inv_m_a, impulse * contact.inv_m_b
        va.vx -= contact.nx * pa
        va.vy -= contact.ny * pa
        va.vz -= contact.nz * pa
        vb.vx += contact.nx * pb
        vb.vy += contact.ny * pb
        vb.vz += contact.nz * pb
        if torque:
            va.wx -= contact.turn_ax * impulse
            va.wy -= contact.turn_ay * impulse
            va.wz -= contact.turn_az * impulse
            vb.wx += contact.turn_bx * impulse
            vb.wy += contact.turn_by * impulse
            vb.wz += contact.turn_bz * impulse

    return kernel(apply_impulse, spec)


def make_append_contact(spec: Spec, capture):
    """Return `kernel(contact, bodies, velocities, pair, params)` that completes a row.

    `capture` is the chain of effects that add to the row's target and compliance.
    """
    torque = spec.has("contact_torque")
    compliant = spec.has("compliance")
    normal_velocity = make_normal_velocity(spec)

    def append_contact(contact, bodies, velocities, pair, params):
        body_a, body_b = bodies[contact.a], bodies[contact.b]
        contact.inv_m_a, contact.inv_m_b = body_a.inv_m, body_b.inv_m
        k_n = body_a.inv_m + body_b.inv_m
        if torque:
            k_n += add_levers(contact, body_a, body_b)
        contact.k_n = k_n
        contact.v_n_pre = normal_velocity(contact, velocities[contact.a], velocities[contact.b])
        contact.target = 0.0
        contact.lambda_n = 0.0
        if compliant:
            contact.gamma = 0.0
        capture(contact, pair, params)
        softened = k_n
        if compliant:
            softened += contact.gamma
        contact.inv_k = 1.0 / softened

    return kernel(append_contact, spec)
