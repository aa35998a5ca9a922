"""The residual of a step: the natural map of its contact laws, in m/s.

Natural map of the complementarity 0 <= lambda_n, 0 <= w with w = v_n + target + gamma lambda_n:
    r = | min((k_n + gamma) lambda_n, w) |
zero exactly at a solution, continuous, and in velocity units because lambda is scaled by the row's
own inverse mass; of what is bilateral r = |w|, where it is bounded no more than what takes its
impulse to the bound. Of friction, with the disc (or the pyramid's
square) of radius mu lambda_n:
    r_t = | k_t lambda_t - proj(k_t lambda_t - v_t) |
Of the convex relaxation (`row_update`), with w = (w_n, v_t), k >= |K| and P_K onto the cone itself:
    r = | k lambda - P_K(k lambda - w) |
Of what resists turning, the same maps in rad/s times a lever (`spin_block`). A contact's residual
is the largest of them, the step's the largest over its contacts.
"""

from __future__ import annotations

from math import sqrt

from .block import largest_response, make_slip_velocity
from .compile import kernel
from .cone import make_project_section, project_cone, within
from .contact import make_frictionless_velocity
from .row_terms import by_friction, row_terms
from .scaled_residual import make_scaled_residual
from .spec import Spec
from .spin_block import make_spin_residual, resists_turning


def make_row_residual(spec: Spec):
    """Return `kernel(contact, va, vb) -> (r, v_n)` [m/s]."""
    return by_friction(spec, _make_frictionless_residual, _make_frictional_residual)


def make_normal_residual(spec: Spec):
    """Return `kernel(contact, v_n) -> r` [m/s]: Signorini's law, of the normal alone."""
    compliant, bilateral = row_terms(spec).compliant, row_terms(spec).bilateral
    bounded = row_terms(spec).bounded

    def normal_residual(contact, v_n):
        w = v_n + contact.target
        if compliant:
            w += contact.gamma * contact.lambda_n
        if bilateral:
            if contact.bilateral == 1:
                if bounded:
                    n = contact.lambda_n
                    if abs(n - w * contact.inv_k) > contact.most:
                        return abs(within(n - w * contact.inv_k, contact.most) - n) / contact.inv_k
                return abs(w)
        # A NaN in the first place of min stays, in the second it is dropped.
        return abs(min(w, contact.lambda_n / contact.inv_k))

    return kernel(normal_residual, spec)


def _make_frictionless_residual(spec: Spec):
    normal_residual, normal_velocity = make_normal_residual(spec), make_frictionless_velocity(spec)

    def row_residual(contact, va, vb):
        v_n = normal_velocity(contact, va, vb)
        return normal_residual(contact, v_n), v_n

    return kernel(row_residual, spec)


def _make_frictional_residual(spec: Spec):
    if spec.friction_cone == "convex":
        return _make_convex_residual(spec)
    project = make_project_section(spec)
    spins, spin_residual = resists_turning(spec), make_spin_residual(spec)
    normal_residual = make_normal_residual(spec)
    slip_velocity = make_slip_velocity(spec)

    def block_residual(contact, va, vb):
        v_n, v_1, v_2 = slip_velocity(contact, va, vb)
        scaled_1, scaled_2 = contact.k_t * contact.lambda_1, contact.k_t * contact.lambda_2
        limit = contact.k_t * contact.mu * contact.lambda_n
        new_1, new_2 = project(scaled_1 - v_1, scaled_2 - v_2, limit)
        new_1, new_2 = new_1 - scaled_1, new_2 - scaled_2
        r_t = sqrt(new_1 * new_1 + new_2 * new_2)
        if spins:
            r_s = spin_residual(contact, va, vb)
            if r_s > r_t or r_s != r_s:
                r_t = r_s
        r_n = normal_residual(contact, v_n)
        return (r_t if r_t > r_n or r_t != r_t else r_n), v_n

    return kernel(block_residual, spec)


def _make_convex_residual(spec: Spec):
    compliant = row_terms(spec).compliant
    spins, spin_residual = resists_turning(spec), make_spin_residual(spec)
    slip_velocity = make_slip_velocity(spec)

    def convex_residual(contact, va, vb):
        v_n, w_1, w_2 = slip_velocity(contact, va, vb)
        w = v_n + contact.target
        if compliant:
            w += contact.gamma * contact.lambda_n
        k = largest_response(contact)
        n, one, two = k * contact.lambda_n, k * contact.lambda_1, k * contact.lambda_2
        x, y, z = project_cone(n - w, one - w_1, two - w_2, contact.mu)
        x, y, z = x - n, y - one, z - two
        r = sqrt(x * x + y * y + z * z)
        if spins:
            r_s = spin_residual(contact, va, vb)
            if r_s > r or r_s != r_s:
                r = r_s
        return r, v_n

    return kernel(convex_residual, spec)


def make_residual(spec: Spec):
    """Return `kernel(contacts, count, velocities) -> (largest residual [m/s], its contact)`.

    Of a problem given by its matrix: the residual without units (`scaled_residual`).
    """
    if spec.operator == "matrix":
        return make_scaled_residual(spec)
    row_residual = make_row_residual(spec)

    def residual(contacts, count, velocities):
        largest, worst = 0.0, -1
        for c in range(count):
            contact = contacts[c]
            r, _ = row_residual(contact, velocities[contact.a], velocities[contact.b])
            # A NaN wins and stays, or divergence would pass for convergence.
            if worst < 0 or r > largest or r != r:
                largest, worst = r, c
        return largest, worst

    return kernel(residual, spec)
