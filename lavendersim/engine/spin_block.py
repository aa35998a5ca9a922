"""Torsional and rolling friction of a contact as one block of angular impulses.

    omega = omega_B - omega_A                      relative angular velocity [rad/s]
    psi = n psi_n + t1 psi_1 + t2 psi_2            angular impulse on B; A gets -psi [N m s]
    S = I_A^-1 + I_B^-1                            what psi does to omega [1/(kg m^2)]
Torsional friction opposes omega about n, rolling friction omega in the tangent plane; each is an
effect of its own that brings its part of psi, and both live in the frame of friction's block.

Residuals and changes are in m/s: a turning rate counts as the speed it gives a centre of mass that
rolls on the contact, omega times `arm`. The coefficients are lengths too, but so small that a
tolerance in them would let bodies creep.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .block import inertia_response
from .compile import inner, kernel
from .effects import made_once
from .row_terms import row_terms
from .spec import Spec


def resists_turning(spec: Spec) -> bool:
    """Whether contacts of this engine resist relative turning."""
    return row_terms(spec).torsional or row_terms(spec).rolling


@inner
def _spin_response(va, vb, x, y, z):
    """Relative angular velocity that a unit angular impulse (x, y, z) gives [1/(kg m^2)]."""
    ax, ay, az = inertia_response(va, x, y, z)
    bx, by, bz = inertia_response(vb, x, y, z)
    return ax + bx, ay + by, az + bz


def make_resists_turning(spec: Spec) -> Any:
    """Return `kernel(pair) -> whether its contacts resist turning`."""
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling

    def pair_resists_turning(pair):
        resists = False
        if torsional:
            resists = pair.torsional_friction > 0.0
        if rolling:
            resists = resists or pair.rolling_friction > 0.0
        return resists

    return kernel(pair_resists_turning, spec)


def make_complete_spin(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb, pair)`: coefficients and responses; psi starts at 0."""
    torsional, complete_torsion = made_once(spec, "complete_torsion")
    rolling, complete_rolling = made_once(spec, "complete_rolling")

    def complete_spin(contact, va, vb, pair):
        squared = 0.0
        if contact.inv_m_a > 0.0:
            x, y, z = contact.rax, contact.ray, contact.raz
            squared = x * x + y * y + z * z
        if contact.inv_m_b > 0.0:
            x, y, z = contact.rbx, contact.rby, contact.rbz
            squared = max(squared, x * x + y * y + z * z)
        contact.arm = sqrt(squared)
        if torsional:
            x, y, z = _spin_response(va, vb, contact.nx, contact.ny, contact.nz)
            complete_torsion(contact, pair, x, y, z)
        if rolling:
            x, y, z = _spin_response(va, vb, contact.t1x, contact.t1y, contact.t1z)
            k_11 = contact.t1x * x + contact.t1y * y + contact.t1z * z
            k_12 = contact.t2x * x + contact.t2y * y + contact.t2z * z
            x, y, z = _spin_response(va, vb, contact.t2x, contact.t2y, contact.t2z)
            k_22 = contact.t2x * x + contact.t2y * y + contact.t2z * z
            complete_rolling(contact, pair, k_11, k_12, k_22)

    return kernel(complete_spin, spec)


def make_apply_spin(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb, n, one, two)`: angular impulses about n, t1, t2 [N m s]."""

    def apply_spin(contact, va, vb, n, one, two):
        x = contact.nx * n + contact.t1x * one + contact.t2x * two
        y = contact.ny * n + contact.t1y * one + contact.t2y * two
        z = contact.nz * n + contact.t1z * one + contact.t2z * two
        wx, wy, wz = inertia_response(va, x, y, z)
        va.wx -= wx
        va.wy -= wy
        va.wz -= wz
        wx, wy, wz = inertia_response(vb, x, y, z)
        vb.wx += wx
        vb.wy += wy
        vb.wz += wz

    return kernel(apply_spin, spec)


def make_apply_start_torques(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb)`: apply the psi that the contact starts the solve with."""
    if not resists_turning(spec):
        return None
    terms = row_terms(spec)
    torsional, rolling = terms.torsional, terms.rolling
    apply_spin = make_apply_spin(spec)

    def apply_start_torques(contact, va, vb):
        n, one, two = 0.0, 0.0, 0.0
        if torsional:
            n = contact.psi_n
        if rolling:
            one, two = contact.psi_1, contact.psi_2
        apply_spin(contact, va, vb, n, one, two)

    return kernel(apply_start_torques, spec)


def make_solve_spin(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb) -> change`: one projected update of psi.

    change: the largest change of the contact's turning rate that it makes, times the arm [m/s].
    """
    if not resists_turning(spec):
        return None
    torsional, solve_torsion = made_once(spec, "solve_torsion")
    rolling, solve_rolling = made_once(spec, "solve_rolling")
    apply_spin = make_apply_spin(spec)

    def solve_spin(contact, va, vb):
        largest = 0.0
        if torsional:
            if contact.torsional > 0.0:
                x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
                change = solve_torsion(contact, contact.nx * x + contact.ny * y + contact.nz * z)
                apply_spin(contact, va, vb, change, 0.0, 0.0)
                largest = abs(change) * contact.k_torsion * contact.arm
        if rolling:
            if contact.rolling > 0.0:
                x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
                one, two = solve_rolling(
                    contact,
                    contact.t1x * x + contact.t1y * y + contact.t1z * z,
                    contact.t2x * x + contact.t2y * y + contact.t2z * z,
                )
                apply_spin(contact, va, vb, 0.0, one, two)
                change = max(abs(one), abs(two)) * contact.k_roll * contact.arm
                # A NaN is greater than anything.
                if change > largest or change != change:
                    largest = change
        return largest

    return kernel(solve_spin, spec)


def make_spin_residual(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb) -> r`: the larger natural-map residual of the two [m/s]."""
    if not resists_turning(spec):
        return None
    torsional, torsion_residual = made_once(spec, "torsion_residual")
    rolling, rolling_residual = made_once(spec, "rolling_residual")

    def spin_residual(contact, va, vb):
        x, y, z = vb.wx - va.wx, vb.wy - va.wy, vb.wz - va.wz
        largest = 0.0
        if torsional:
            spin = contact.nx * x + contact.ny * y + contact.nz * z
            largest = torsion_residual(contact, spin)
        if rolling:
            r = rolling_residual(
                contact,
                contact.t1x * x + contact.t1y * y + contact.t1z * z,
                contact.t2x * x + contact.t2y * y + contact.t2z * z,
            )
            if r > largest or r != r:
                largest = r
        return largest * contact.arm

    return kernel(spin_residual, spec)
