"""Projection of joints by Newton's method, where sweeps do not bring their ends together.

Pushes obey the law of impulses, without friction and in metres: v the pseudo-velocities u, and for
the target -(what is to be moved). So the same method solves them, on the rows of the step, which
keep what they have meanwhile. In a loop of joints, rows of which are too many, sweeps need
thousands to do so, and what they leave turns axes out of each other: rows then contradict.
"""

from __future__ import annotations

from math import inf
from typing import Any

from .compile import kernel
from .row_terms import row_terms
from .spec import Spec

# Sweeps that its steps may cost as much as, and multiplications of a visit of one (`adaptive`).
WORTH, VISIT = 3000.0, 50.0
# Steps at most: some five do where rows agree, and where they do not pushes only grow.
STEPS = 24.0


def make_project_joints(spec: Spec) -> Any:
    """Return `kernel(system, workspace, tolerance)`: pushes go on to where ends are together.

    system: with the pseudo-velocities that the pushes of its contacts give; workspace: of the
    solver; tolerance [m].
    """
    from .solvers.newton.method import FEWEST_STEPS, make_newton, make_step_cost

    newton, step_cost, terms = make_newton(spec), make_step_cost(spec), row_terms(spec)
    friction, compliant, bounded = terms.frictional, terms.compliant, terms.bounded

    def exchange(contact):
        # Impulses for pushes, and back.
        contact.lambda_n, contact.push = contact.push, contact.lambda_n
        contact.target, contact.correction = -contact.correction, -contact.target
        if friction:
            contact.mu, contact.own_mu = contact.own_mu, contact.mu
            contact.lambda_1, contact.own_1 = contact.own_1, contact.lambda_1
            contact.lambda_2, contact.own_2 = contact.own_2, contact.lambda_2
        if compliant:
            contact.gamma, contact.own_gamma = contact.own_gamma, contact.gamma
        if bounded:
            contact.most, contact.own_most = contact.own_most, contact.most

    exchange = kernel(exchange, spec)

    def project_joints(system, workspace, tolerance):
        contacts, count = system.contacts, system.count
        size, cost = step_cost(system, workspace)
        most = min(STEPS, VISIT * count * WORTH / cost) if cost < inf else 0.0
        if most < FEWEST_STEPS:
            return
        for c in range(count):
            contact = contacts[c]
            if friction:
                contact.own_mu, contact.own_1, contact.own_2 = 0.0, 0.0, 0.0
            if compliant:
                contact.own_gamma = 0.0
            if bounded:
                contact.own_most = contact.most if contact.motor == 0 else 0.0
            exchange(contact)
        newton(system, workspace, size, most, tolerance, True)
        for c in range(count):
            exchange(contacts[c])

    return kernel(project_joints, spec)
