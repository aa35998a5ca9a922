"""One contact's impulses enter, corrected ones leave: the update every relaxation solver repeats.

Normal, compliant:
    lambda_n <- max(0, lambda_n - (v_n + b + b_rest + gamma lambda_n) / (k_n + gamma))
Friction, with v_t after the normal's change:
    lambda_t <- lambda_t - K_tt^-1 v_t                              where that is in the disc: stick
                proj(lambda_t - v_t / k_t),  |lambda_t| <= mu lambda_n          otherwise: slide
Both tangential forms have the same fixed point, Coulomb's law with maximal dissipation; k_t, the
largest eigenvalue of K_tt, makes the second one a descent step. What resists turning follows with
the new lambda_n (`spin_block`).
"""

from __future__ import annotations

from math import sqrt

from ..compile import kernel
from ..contact import make_smooth_impulse, make_smooth_velocity
from ..coupling import make_add_rough, make_rough_velocity
from ..effects.smooth_contact import by_roughness
from ..spec import Spec
from ..spin_block import make_solve_spin, resists_turning


def make_solve_contact_velocity(spec: Spec):
    """Return `kernel(contact, contacts, velocities) -> change`: one projected, compliant update.

    change: the largest change of the contact's velocity that the update makes [m/s].
    """
    if spec.operator == "matrix":
        return _make_block(spec)
    return by_roughness(spec, _make_normal, _make_block)


def _make_normal(spec: Spec):
    compliant = spec.has("compliance")
    normal_velocity = make_smooth_velocity(spec)
    apply_impulse = make_smooth_impulse(spec)

    def solve_contact_velocity(contact, contacts, velocities):
        va, vb = velocities[contact.a], velocities[contact.b]
        w = normal_velocity(contact, va, vb) + contact.target
        lambda_old = contact.lambda_n
        if compliant:
            w += contact.gamma * lambda_old
        # In this order a NaN stays and is reported; max(0.0, NaN) would be 0.
        lambda_new = max(lambda_old - w * contact.inv_k, 0.0)
        contact.lambda_n = lambda_new
        change = lambda_new - lambda_old
        apply_impulse(contact, va, vb, change)
        return abs(change) * contact.k_n

    return kernel(solve_contact_velocity, spec)


def _make_block(spec: Spec):
    compliant = spec.has("compliance")
    pyramid = spec.friction_cone == "pyramid"
    spins, solve_spin = resists_turning(spec), make_solve_spin(spec)
    contact_velocity, add_impulse = make_rough_velocity(spec), make_add_rough(spec)

    def solve_contact_block(contact, contacts, velocities):
        w, w1, w2 = contact_velocity(contact, velocities)
        old_n, old_1, old_2 = contact.lambda_n, contact.lambda_1, contact.lambda_2
        if compliant:
            w += contact.gamma * old_n
        new_n = max(old_n - w * contact.inv_k, 0.0)
        change_n = new_n - old_n
        w1 += contact.k_n1 * change_n
        w2 += contact.k_n2 * change_n
        limit = contact.mu * new_n
        new_1 = old_1 - contact.i_11 * w1 - contact.i_12 * w2
        new_2 = old_2 - contact.i_12 * w1 - contact.i_22 * w2
        if pyramid:
            new_1 = min(max(new_1, -limit), limit)
            new_2 = min(max(new_2, -limit), limit)
        elif new_1 * new_1 + new_2 * new_2 > limit * limit:
            new_1, new_2 = old_1 - w1 / contact.k_t, old_2 - w2 / contact.k_t
            squared = new_1 * new_1 + new_2 * new_2
            if squared > limit * limit:
                scale = limit / sqrt(squared)
                new_1, new_2 = new_1 * scale, new_2 * scale
        contact.lambda_n, contact.lambda_1, contact.lambda_2 = new_n, new_1, new_2
        change_1, change_2 = new_1 - old_1, new_2 - old_2
        add_impulse(contact, contacts, velocities, change_n, change_1, change_2)
        # In this order a NaN stays.
        change = max(
            max(abs(change_n) * contact.k_n, abs(change_1) * contact.k_t),
            abs(change_2) * contact.k_t,
        )
        if spins:
            turned = solve_spin(contact, velocities[contact.a], velocities[contact.b])
            if turned > change or turned != turned:
                change = turned
        return change

    return kernel(solve_contact_block, spec)
