"""Impulses of a contact that leave a solved step its laws, and their response to stiff dampers.

They are a face of Coulomb's cone, by what the contact does at the velocities v* of the solve:
    open     it parts:                     no impulse
    sticks   closed, without slip:         the cone |lambda_t| <= mu lambda_n
    slides   closed, with slip w_t:        lambda_n >= 0, and friction mu lambda_n against the slip
    spent    a motor that drives by its most: that impulse
Open and stuck ones respond as in `response`, by the point of the face nearest to x = lambda^k - e w
in the metric 1/e. What slides responds along its normal alone, its friction is given for a round:
compliance gives way to pressure, whatever slips. w are changes from v*, but for the slip.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from ...block import make_slip_velocity
from ...compile import kernel
from ...contact import make_frictionless_velocity
from ...row_terms import by_friction, row_terms
from ...spec import Spec
from .response import (
    Stiffness,
    make_frictional_stiffness,
    make_frictionless_stiffness,
    make_projected_block,
    make_projected_normal,
)

OPEN, STICKS, SLIDES, SPENT = 0, 1, 2, 3


def make_find_face(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb, still)`: its face, and the impulses it starts with.

    still: contacts that part or slip no faster are closed and stuck [m/s].
    """
    return by_friction(spec, _make_find_normal, _make_find_block)


def _make_find_normal(spec: Spec) -> Any:
    normal_velocity, compliant = make_frictionless_velocity(spec), row_terms(spec).compliant
    tangents, bilateral = row_terms(spec).frictional, row_terms(spec).bilateral
    bounded = row_terms(spec).bounded

    def find_normal(contact, va, vb, still):
        parting = normal_velocity(contact, va, vb) + contact.target
        if compliant:
            parting += contact.gamma * contact.lambda_n
        contact.face = STICKS if contact.lambda_n > 0.0 or parting <= still else OPEN
        if bilateral:
            if contact.bilateral == 1:
                contact.face = STICKS
        if bounded:
            if contact.motor == 1 and abs(parting) > still:
                contact.face = SPENT
        contact.start_n = contact.lambda_n
        if tangents:
            contact.start_1, contact.start_2 = 0.0, 0.0

    return kernel(find_normal, spec)


def _make_find_block(spec: Spec) -> Any:
    slip_velocity, compliant = make_slip_velocity(spec), row_terms(spec).compliant

    def find_block(contact, va, vb, still):
        parting, one, two = slip_velocity(contact, va, vb)
        parting += contact.target
        if compliant:
            parting += contact.gamma * contact.lambda_n
        contact.face = OPEN
        if contact.lambda_n > 0.0 or parting <= still:
            contact.face = STICKS
            slip = sqrt(one * one + two * two)
            if slip > still:
                contact.face = SLIDES
                contact.slip_1, contact.slip_2 = one, two
                contact.given_1, contact.given_2 = contact.lambda_1, contact.lambda_2
        contact.start_n = contact.lambda_n
        contact.start_1, contact.start_2 = contact.lambda_1, contact.lambda_2

    return kernel(find_block, spec)


def make_face_impulse(spec: Spec) -> Any:
    """Return `kernel(contact, length) -> (lambda_n, lambda_1, lambda_2)` so far along the step."""
    return by_friction(spec, _make_normal_impulse, _make_block_impulse)


def _make_normal_impulse(spec: Spec) -> Any:
    projected_normal, bounded = make_projected_normal(spec), row_terms(spec).bounded

    def normal_impulse(contact, length):
        if bounded:
            if contact.face == SPENT:
                return contact.start_n, 0.0, 0.0
        if contact.face == OPEN:
            return 0.0, 0.0, 0.0
        return projected_normal(contact, length)

    return kernel(normal_impulse, spec)


def _make_block_impulse(spec: Spec) -> Any:
    projected_normal = make_projected_normal(spec)
    projected_block = make_projected_block(spec)

    def block_impulse(contact, length):
        if contact.face == OPEN:
            return 0.0, 0.0, 0.0
        if contact.face == SLIDES:
            n, _, _ = projected_normal(contact, length)
            return n, contact.given_1, contact.given_2
        return projected_block(contact, length)

    return kernel(block_impulse, spec)


def make_turn_friction(spec: Spec) -> Any:
    """Return `kernel(contact) -> change` [N s]: friction of what slides, at its pressure and slip.

    None without friction.
    """
    if not row_terms(spec).frictional:
        return None

    def turn_friction(contact):
        # velocity_1, velocity_2: changes of the slip from v*
        if contact.face != SLIDES:
            return 0.0
        n, _, _ = face_impulse(contact, 0.0)
        x, y = contact.slip_1 + contact.velocity_1, contact.slip_2 + contact.velocity_2
        scale = -contact.mu * n / sqrt(x * x + y * y)
        change = max(abs(scale * x - contact.given_1), abs(scale * y - contact.given_2))
        contact.given_1, contact.given_2 = scale * x, scale * y
        return change

    face_impulse = make_face_impulse(spec)
    return kernel(turn_friction, spec)


def make_face_stiffness(spec: Spec) -> Any:
    """Return `kernel(contact) -> Stiffness`."""
    return by_friction(spec, _make_normal_stiffness, _make_block_stiffness)


def _make_normal_stiffness(spec: Spec) -> Any:
    frictionless_stiffness = make_frictionless_stiffness(spec)

    def normal_stiffness(contact):
        if contact.face == OPEN or contact.face == SPENT:
            return Stiffness(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        return frictionless_stiffness(contact)

    return kernel(normal_stiffness, spec)


def _make_block_stiffness(spec: Spec) -> Any:
    frictionless_stiffness = make_frictionless_stiffness(spec)
    frictional_stiffness = make_frictional_stiffness(spec)

    def block_stiffness(contact):
        if contact.face == OPEN:
            return Stiffness(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if contact.face == SLIDES:
            return frictionless_stiffness(contact)
        return frictional_stiffness(contact)

    return kernel(block_stiffness, spec)
