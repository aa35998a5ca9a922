"""Jacobi: all contacts are updated at the same velocities, then all impulses act at once.

    r_n <- max(0, r_n - w_n / c),    r_t <- proj(r_t - w_t / c),  |r_t| <= mu r_n
c is so stiff (`step_bound`) that together they cannot overshoot. Nothing depends on the order, and
machines with thousands of threads pay for that with some times as many sweeps as Gauss-Seidel.
What resists turning is swept one after the other.
"""

from __future__ import annotations

from typing import Any

from ..compile import kernel
from ..cone import make_project_section, project_cone
from ..coupling import make_add_impulse, make_contact_velocity
from ..row_terms import row_terms
from ..spec import Spec
from ..spin_block import make_solve_spin, resists_turning
from . import step_bound
from .iteration import Carry, Iteration
from .solver import Solver

CONTACT_FIELDS = [
    *step_bound.CONTACT_FIELDS,
    ("change_n", "f8"),  # of the impulse, in this sweep [N s]
    ("change_1", "f8"),
    ("change_2", "f8"),
]
# Sweeps between two evaluations of the residual.
RESIDUAL_EVERY = 8


def make_update(spec: Spec) -> Any:
    """Return `kernel(contact, velocities) -> change` [m/s]: the contact's own new impulse."""
    terms = row_terms(spec)
    friction, compliant = terms.frictional, terms.compliant
    project = make_project_section(spec)
    convex = friction and spec.friction_cone == "convex"
    contact_velocity = make_contact_velocity(spec)

    def update(contact, velocities):
        w, w1, w2 = contact_velocity(contact, velocities)
        if compliant:
            w += contact.gamma * contact.lambda_n
        change = 0.0
        new_n = contact.lambda_n - w / contact.bound
        if not convex:
            # In this order a NaN stays.
            new_n = max(new_n, 0.0)
        if friction:
            limit = contact.mu * new_n
            new_1 = contact.lambda_1 - w1 / contact.bound
            new_2 = contact.lambda_2 - w2 / contact.bound
            if convex:
                new_n, new_1, new_2 = project_cone(new_n, new_1, new_2, contact.mu)
            else:
                new_1, new_2 = project(new_1, new_2, limit)
            contact.change_1 = new_1 - contact.lambda_1
            contact.change_2 = new_2 - contact.lambda_2
            contact.lambda_1, contact.lambda_2 = new_1, new_2
            change = max(abs(contact.change_1), abs(contact.change_2))
        contact.change_n = new_n - contact.lambda_n
        contact.lambda_n = new_n
        # In this order a NaN stays.
        return max(abs(contact.change_n), change) * contact.bound

    return kernel(update, spec)


def make_apply_changes(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities) -> change` [m/s]: all changes reach velocities.

    change: of what resists turning, which follows; 0 without it.
    """
    friction = row_terms(spec).frictional
    add_impulse = make_add_impulse(spec)
    spins, solve_spin = resists_turning(spec), make_solve_spin(spec)

    def apply_changes(contacts, count, velocities):
        greatest = 0.0
        for c in range(count):
            contact = contacts[c]
            one, two = 0.0, 0.0
            if friction:
                one, two = contact.change_1, contact.change_2
            if contact.change_n != 0.0 or one != 0.0 or two != 0.0:
                add_impulse(contact, contacts, velocities, contact.change_n, one, two)
        if spins:
            for c in range(count):
                contact = contacts[c]
                turned = solve_spin(contact, velocities[contact.a], velocities[contact.b])
                if turned > greatest or turned != turned:
                    greatest = turned
        return greatest

    return kernel(apply_changes, spec)


def make(spec: Spec) -> Iteration:
    """Return the sweeps: all contacts look, then all act."""
    bound = step_bound.make_bound(spec)
    update, apply_changes = make_update(spec), make_apply_changes(spec)

    def prepare(system, workspace, params, counters):
        bound(system.contacts, system.count, workspace)
        return Carry(params.tolerance)

    def sweep_at_once(system, workspace, params, counters, carry):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        greatest = 0.0
        for c in range(count):
            change = update(contacts[c], velocities)
            # A NaN is greater than anything.
            if change > greatest or change != change:
                greatest = change
        turned = apply_changes(contacts, count, velocities)
        if turned > greatest or turned != turned:
            greatest = turned
        return greatest, carry

    return Iteration(
        kernel(sweep_at_once, spec), prepare=kernel(prepare, spec), residual_every=RESIDUAL_EVERY
    )


SOLVER = Solver(
    name="jacobi",
    iteration=make,
    allocate=step_bound.allocate,
    contact_fields=CONTACT_FIELDS,
)
