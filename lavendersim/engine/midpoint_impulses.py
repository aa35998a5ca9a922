"""Impulses from one pass at the middle of the step to the next (`effects.contact_midpoint`).

A pass has the contacts of the one before it, in the same order: each goes on from its own impulse,
whatever the length of the part. The cache of warm starts is for contacts that have to be found
again; brief parts leave it as it is, and a pass that went by it would never meet its own solution.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .compile import kernel
from .row_terms import row_terms
from .spec import Spec


class Impulse(NamedTuple):
    """What a contact pushes by: along its normal, in its tangent plane, and its torques."""

    n: float  # [N s]
    x: float  # of friction, world axes [N s]
    y: float
    z: float
    psi_n: float  # along the normal [N m s]
    psi_x: float  # in the tangent plane, world axes [N m s]
    psi_y: float
    psi_z: float


def make_impulse_of(spec: Spec) -> Any:
    """Return `kernel(contact) -> Impulse`, before the row is completed at another middle."""
    terms = row_terms(spec)
    friction, torsional, rolling = terms.frictional, terms.torsional, terms.rolling

    def impulse_of(contact):
        x, y, z = 0.0, 0.0, 0.0
        psi_n, psi_x, psi_y, psi_z = 0.0, 0.0, 0.0, 0.0
        if friction:
            one, two = contact.lambda_1, contact.lambda_2
            x = contact.t1x * one + contact.t2x * two
            y = contact.t1y * one + contact.t2y * two
            z = contact.t1z * one + contact.t2z * two
        if torsional:
            psi_n = contact.psi_n
        if rolling:
            one, two = contact.psi_1, contact.psi_2
            psi_x = contact.t1x * one + contact.t2x * two
            psi_y = contact.t1y * one + contact.t2y * two
            psi_z = contact.t1z * one + contact.t2z * two
        return Impulse(contact.lambda_n, x, y, z, psi_n, psi_x, psi_y, psi_z)

    return kernel(impulse_of, spec)


def make_go_on(spec: Spec) -> Any:
    """Return `kernel(contact, impulse)`: its part in the tangent plane of now; none is applied."""
    terms = row_terms(spec)
    friction, torsional, rolling = terms.frictional, terms.torsional, terms.rolling
    stretched = terms.stretched

    def go_on(contact, old):
        contact.lambda_n = old.n
        if friction:
            contact.lambda_1 = contact.t1x * old.x + contact.t1y * old.y + contact.t1z * old.z
            contact.lambda_2 = contact.t2x * old.x + contact.t2y * old.y + contact.t2z * old.z
            if stretched:
                contact.lambda_1 *= contact.ease_1
                contact.lambda_2 *= contact.ease_2
        # What begins without a push begins without torque: neither is applied.
        if torsional:
            if old.n > 0.0:
                contact.psi_n = old.psi_n
        if rolling:
            if old.n > 0.0:
                x, y, z = old.psi_x, old.psi_y, old.psi_z
                contact.psi_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
                contact.psi_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z

    return kernel(go_on, spec)
