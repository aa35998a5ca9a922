"""What rounds of Newton's method leave begins again from inside the cones, and rounds follow.

Where every contact is a cone, whatever else an engine knows: a scene's bits are those of an engine
without. What is left is no worse than before.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel, separate
from ...residual import make_residual
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from .alart_curnier import make_alart_curnier
from .inside_cones import LONG_STEPS, MOST, SHORT_STEPS, make_from_inside
from .method import make_set_impulse
from .rounds import STIFF_ENOUGH
from .torques import make_limits_torque

# Steps of the rounds that follow: from near their end they take a few.
FINISHING = 40.0
# Columns of `Envelope.inside` behind those of `inside_cones`: impulses of before [N s]
BEFORE_N, BEFORE_1, BEFORE_2 = range(3, 6)


def make_are_cones(spec: Spec) -> Any:
    """Return `kernel(contacts, count) -> whether` all are: rigid, one-sided, of no torque."""
    terms = row_terms(spec)
    bilateral, compliant, spins = terms.bilateral, terms.compliant, resists_turning(spec)
    limits_torque: Any = make_limits_torque(spec) if spins else None

    def are_cones(contacts, count):
        for c in range(count):
            contact, other = contacts[c], False
            if bilateral:
                other = contact.bilateral == 1
            if compliant:
                other = other or contact.gamma > 0.0
            if spins:
                other = other or limits_torque(contact)
            if other:
                return False
        return True

    return kernel(are_cones, spec)


def make_begin_again(spec: Spec) -> Any:
    """Return `kernel(system, workspace, size, most, residuals) -> steps`.

    As that of `make_alart_curnier`, whose rounds follow: from inside, they find who holds, slides
    and opens. None where a contact is no cone. Impulses that are no better than those of before are
    taken back.
    """
    if not row_terms(spec).frictional:
        return None
    residual, from_inside = make_residual(spec), make_from_inside(spec)
    alart_curnier, set_impulse = make_alart_curnier(spec), make_set_impulse(spec)
    are_cones = make_are_cones(spec)

    def begin_again(system, workspace, size, most, residuals):
        tolerance, enough = residuals
        contacts, count, velocities = system.contacts, system.count, system.velocities
        before, _ = residual(contacts, count, velocities)
        if before <= enough or not are_cones(contacts, count):
            return 0
        for c in range(count):
            contact, kept = contacts[c], workspace.inside[c]
            kept[BEFORE_N] = contact.lambda_n
            kept[BEFORE_1], kept[BEFORE_2] = contact.lambda_1, contact.lambda_2
        steps, after = 0, before
        for strategy in (LONG_STEPS, SHORT_STEPS):
            if not after <= enough:
                steps += from_inside(
                    system, workspace, size, min(most, float(MOST)), strategy, tolerance
                )
                steps += alart_curnier(
                    system, workspace, size, min(most, FINISHING), residuals, STIFF_ENOUGH
                )
                after, _ = residual(contacts, count, velocities)
        if not after < before:
            for c in range(count):
                kept = workspace.inside[c]
                n, one, two = kept[BEFORE_N], kept[BEFORE_1], kept[BEFORE_2]
                set_impulse(contacts[c], velocities, n, one, two)
        return steps

    return separate(kernel(begin_again, spec), spec)
