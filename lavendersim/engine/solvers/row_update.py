"""The update of one contact that every relaxation solver repeats: projected, by blocks.

Normal, compliant:
    lambda_n <- max(0, lambda_n - (v_n + b + b_rest + gamma lambda_n) / (k_n + gamma))
without the bound by 0 where the row is `bilateral`; a motor's (`effects.motor`) has one
of either sign.
Friction, with v_t after the normal's change:
    lambda_t <- lambda_t - K_tt^-1 v_t                              where that is in the disc: stick
                proj(lambda_t - v_t / k_t),  |lambda_t| <= mu lambda_n          otherwise: slide
Both tangential forms have the same fixed point, Coulomb's law with maximal dissipation; k_t, the
largest eigenvalue of K_tt, makes the second one a descent step. What resists turning follows with
the new lambda_n (`spin_block`).

The convex relaxation (`friction_cone: convex`) is the law w in K*, lambda in K, w . lambda = 0
without De Saxce's shift: a quadratic program over the cones K = {|lambda_t| <= mu lambda_n}.
    lambda <- lambda - K^-1 w                               where that is in the cone: stick
              P_K(lambda - w / k),  k >= |K|                otherwise
Under it a contact that slides opens with w_n = mu |w_t|.

Over-relaxed, v and w above are multiplied by a factor between 0 and 2; impulses are projected
afterwards. A factor of 1 gives the bits of none.
"""

from __future__ import annotations

from ..block import largest_response
from ..compile import kernel
from ..cone import project_cone, project_disc, project_square, within
from ..contact import make_frictionless_impulse, make_frictionless_velocity
from ..coupling import make_add_frictional, make_frictional_velocity
from ..effects import made_once
from ..row_terms import by_friction, row_terms
from ..spec import Spec
from ..spin_block import make_solve_spin, resists_turning


def make_solve_contact_velocity(spec: Spec):
    """Return `kernel(contact, contacts, velocities, params) -> change`: one projected update.

    change: the largest change of the contact's velocity that the update makes [m/s].
    """
    make_frictional = _make_convex if spec.friction_cone == "convex" else _make_block
    if spec.operator == "matrix":
        return make_frictional(spec)
    return by_friction(spec, _make_normal, make_frictional)


def _make_normal(spec: Spec):
    compliant, relaxed = row_terms(spec).compliant, spec.over_relaxation
    recaptures, capture_again = made_once(spec, "recapture")
    normal_velocity = make_frictionless_velocity(spec)
    apply_impulse = make_frictionless_impulse(spec)
    bilateral, bounded = row_terms(spec).bilateral, row_terms(spec).bounded

    def solve_contact_velocity(contact, contacts, velocities, params):
        va, vb = velocities[contact.a], velocities[contact.b]
        w = normal_velocity(contact, va, vb) + contact.target
        lambda_old = contact.lambda_n
        if recaptures:
            w = capture_again(contact, w, params)
        if compliant:
            w += contact.gamma * lambda_old
        if relaxed:
            w *= params.over_relaxation
        # In this order a NaN stays and is reported; max(0.0, NaN) would be 0.
        lambda_new = max(lambda_old - w * contact.inv_k, 0.0)
        if bilateral:
            if contact.bilateral == 1:
                lambda_new = lambda_old - w * contact.inv_k
                if bounded:
                    lambda_new = within(lambda_new, contact.most)
        contact.lambda_n = lambda_new
        change = lambda_new - lambda_old
        apply_impulse(contact, va, vb, change)
        return abs(change) * contact.k_n

    return kernel(solve_contact_velocity, spec)


def _make_give(spec: Spec):
    """Return `kernel(contact, contacts, velocities, n, one, two) -> change`: its new impulses.

    Velocities follow, and so does what resists turning.
    """
    add_impulse = make_add_frictional(spec)
    spins, solve_spin = resists_turning(spec), make_solve_spin(spec)

    def give(contact, contacts, velocities, n, one, two):
        change_n, change_1 = n - contact.lambda_n, one - contact.lambda_1
        change_2 = two - contact.lambda_2
        contact.lambda_n, contact.lambda_1, contact.lambda_2 = n, one, two
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

    return kernel(give, spec)


def _make_block(spec: Spec):
    compliant, relaxed = row_terms(spec).compliant, spec.over_relaxation
    recaptures, capture_again = made_once(spec, "recapture")
    pyramid = spec.friction_cone == "pyramid"
    contact_velocity, give = make_frictional_velocity(spec), _make_give(spec)

    def solve_contact_block(contact, contacts, velocities, params):
        w, w1, w2 = contact_velocity(contact, velocities)
        old_n, old_1, old_2 = contact.lambda_n, contact.lambda_1, contact.lambda_2
        if recaptures:
            w = capture_again(contact, w, params)
        if compliant:
            w += contact.gamma * old_n
        if relaxed:
            w *= params.over_relaxation
        new_n = max(old_n - w * contact.inv_k, 0.0)
        change_n = new_n - old_n
        w1 += contact.k_n1 * change_n
        w2 += contact.k_n2 * change_n
        if relaxed:
            w1 *= params.over_relaxation
            w2 *= params.over_relaxation
        limit = contact.mu * new_n
        new_1 = old_1 - contact.i_11 * w1 - contact.i_12 * w2
        new_2 = old_2 - contact.i_12 * w1 - contact.i_22 * w2
        if pyramid:
            new_1, new_2 = project_square(new_1, new_2, limit)
        elif new_1 * new_1 + new_2 * new_2 > limit * limit:
            new_1, new_2 = old_1 - w1 / contact.k_t, old_2 - w2 / contact.k_t
            new_1, new_2 = project_disc(new_1, new_2, limit)
        return give(contact, contacts, velocities, new_n, new_1, new_2)

    return kernel(solve_contact_block, spec)


def _make_convex(spec: Spec):
    compliant, relaxed = row_terms(spec).compliant, spec.over_relaxation
    recaptures, capture_again = made_once(spec, "recapture")
    contact_velocity, give = make_frictional_velocity(spec), _make_give(spec)

    def solve_contact_convex(contact, contacts, velocities, params):
        w, w1, w2 = contact_velocity(contact, velocities)
        old_n, old_1, old_2 = contact.lambda_n, contact.lambda_1, contact.lambda_2
        mu, k_n1, k_n2 = contact.mu, contact.k_n1, contact.k_n2
        if recaptures:
            w = capture_again(contact, w, params)
        if compliant:
            w += contact.gamma * old_n
        if relaxed:
            w *= params.over_relaxation
            w1 *= params.over_relaxation
            w2 *= params.over_relaxation
        # The block's own solution, by elimination of the tangents.
        eliminated_1 = contact.i_11 * k_n1 + contact.i_12 * k_n2
        eliminated_2 = contact.i_12 * k_n1 + contact.i_22 * k_n2
        left = 1.0 / contact.inv_k - eliminated_1 * k_n1 - eliminated_2 * k_n2
        change_n = (eliminated_1 * w1 + eliminated_2 * w2 - w) / left
        new_n = old_n + change_n
        new_1 = old_1 - contact.i_11 * w1 - contact.i_12 * w2 - eliminated_1 * change_n
        new_2 = old_2 - contact.i_12 * w1 - contact.i_22 * w2 - eliminated_2 * change_n
        if not (new_n >= 0.0 and new_1 * new_1 + new_2 * new_2 <= mu * mu * new_n * new_n):
            step = 1.0 / largest_response(contact)
            new_n, new_1, new_2 = project_cone(
                old_n - step * w, old_1 - step * w1, old_2 - step * w2, mu
            )
        return give(contact, contacts, velocities, new_n, new_1, new_2)

    return kernel(solve_contact_convex, spec)
