"""The projected impulse of a contact, as a function of velocities, and its derivative.

At contact velocity w, around the impulse lambda^k that a round begins with, it is the nearest in
Coulomb's cone, nearest in the metric 1/e:
    lambda = proj(x),   x = s lambda^k - e w,   |lambda_t| <= mu lambda_n,
s = 1/(1 + E gamma) and e = E s along the normal, where compliance gamma is; 1 and E elsewhere.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ...block import make_relative_velocity
from ...compile import inner, kernel
from ...cone import within
from ...contact import make_frictionless_velocity
from ...row_terms import by_friction, row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import OF_A, OF_B, T1, T2, WX, WY, WZ, N, X, Y, Z
from .torques import make_start_torques

# How De Saxce's shifts of a round follow from those of the round before.
PLAIN, SECANT, TOGETHER = 0, 1, 2


def make_start(spec: Spec):
    """Return `kernel(contacts, count, velocities, softness, at_rest, stalls)`.

    A round begins, around the impulses of now. 1/softness is the stiffness of a projected impulse,
    relative to the row's own effective mass [-]; at_rest: what slides is taken to stop;
    stalls: how shifts go on, PLAIN, each by the SECANT of its last two, or as they are, brought on
    TOGETHER before (`shifts`).
    """
    compliant = row_terms(spec).compliant
    start_velocity = by_friction(spec, _make_start_normal, _make_start_block)
    spins, start_torques = resists_turning(spec), make_start_torques(spec)

    def start(contacts, count, velocities, softness, at_rest, stalls):
        for c in range(count):
            contact = contacts[c]
            va, vb = velocities[contact.a], velocities[contact.b]
            stiff = 1.0 / (softness * contact.k_n)
            contact.scale = 1.0
            if compliant:
                contact.scale = 1.0 / (1.0 + stiff * contact.gamma)
            contact.stiff_n = stiff * contact.scale
            contact.start_n = contact.lambda_n
            if spins:
                start_torques(contact, va, vb, softness)
            start_velocity(contact, va, vb, softness, at_rest, stalls)

    return kernel(start, spec)


def _make_start_normal(spec: Spec):
    tangents = row_terms(spec).frictional
    normal_velocity = make_frictionless_velocity(spec)

    def start_normal(contact, va, vb, softness, at_rest, stalls):
        contact.velocity_n = normal_velocity(contact, va, vb) + contact.target
        if tangents:
            contact.start_1, contact.start_2 = 0.0, 0.0

    return kernel(start_normal, spec)


# Slopes of the defect over the shift that a secant is drawn for [-].
STEEPEST, FLATTEST = -2.0, -0.1


@inner
def update_shift(contact, slip, stalls):
    """Bring De Saxce's shift to mu |v_t|, `slip`, that the last one led to [m/s].

    A shift taken too small lifts the contact by the rest, which pushes it less, and friction then
    leaves it more slip: by itself the error falls by a constant factor a round, a half for a ball.
    The secant finds the end of that.
    """
    defect = slip - contact.shift
    change = defect
    if stalls and contact.shift_change != 0.0:
        slope = (defect - contact.defect) / contact.shift_change
        if STEEPEST < slope < FLATTEST:
            change = -defect / slope
    old = contact.shift
    contact.shift = max(old + change, 0.0)
    contact.shift_change, contact.defect = contact.shift - old, defect


def _make_start_block(spec: Spec):
    shifted, yielding = row_terms(spec).shifted, row_terms(spec).yielding
    relative_velocity = make_relative_velocity(spec)

    def start_block(contact, va, vb, softness, at_rest, stalls):
        x, y, z = relative_velocity(contact, va, vb)
        contact.velocity_n = contact.nx * x + contact.ny * y + contact.nz * z + contact.target
        contact.velocity_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        contact.velocity_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        if shifted:
            contact.velocity_1 += contact.surface_1
            contact.velocity_2 += contact.surface_2
        contact.stiff_t = 1.0 / (softness * contact.k_t)
        if yielding:  # s lambda^k - e w is lambda^k - e (w + gamma lambda^k)
            contact.velocity_1 += contact.gamma_t * contact.lambda_1
            contact.velocity_2 += contact.gamma_t * contact.lambda_2
            contact.stiff_t = 1.0 / (softness * contact.k_t + contact.gamma_t)
        if at_rest:
            contact.shift, contact.defect, contact.shift_change = 0.0, 0.0, 0.0
        else:
            if stalls != TOGETHER:
                one, two = contact.velocity_1, contact.velocity_2
                slip = sqrt(one * one + two * two)
                update_shift(contact, contact.mu * slip, stalls == SECANT)
            contact.velocity_n += contact.shift
        contact.start_1, contact.start_2 = contact.lambda_1, contact.lambda_2

    return kernel(start_block, spec)


def make_projected_impulse(spec: Spec):
    """Return `kernel(contact, length) -> (lambda_n, lambda_1, lambda_2)` so far along the step."""
    return by_friction(spec, make_projected_normal, make_projected_block)


def make_projected_normal(spec: Spec):
    """Return the same kernel for contacts without friction."""
    bilateral, bounded = row_terms(spec).bilateral, row_terms(spec).bounded

    def frictionless_impulse(contact, length):
        n = contact.scale * contact.start_n
        n -= contact.stiff_n * (contact.velocity_n + length * contact.step_n)
        if bilateral:
            if contact.bilateral == 1:
                if bounded:
                    n = within(n, contact.most)
                return n, 0.0, 0.0
        return max(n, 0.0), 0.0, 0.0

    return kernel(frictionless_impulse, spec)


def make_projected_block(spec: Spec):
    """Return the same kernel for contacts with friction."""

    def projected_impulse(contact, length):
        n = contact.scale * contact.start_n
        n -= contact.stiff_n * (contact.velocity_n + length * contact.step_n)
        one = contact.start_1 - contact.stiff_t * (contact.velocity_1 + length * contact.step_1)
        two = contact.start_2 - contact.stiff_t * (contact.velocity_2 + length * contact.step_2)
        mu = contact.mu
        r = sqrt(one * one + two * two)
        if r <= mu * n:
            return n, one, two
        weight = mu * contact.stiff_n / contact.stiff_t
        n = (n + weight * r) / (1.0 + weight * mu)
        if n <= 0.0:
            return 0.0, 0.0, 0.0
        scale = mu * n / r
        return n, one * scale, two * scale

    return kernel(projected_impulse, spec)


class Stiffness(NamedTuple):
    """E' = -d lambda / d w of a contact, in its frame; symmetric [kg]."""

    nn: float
    n1: float
    n2: float
    t11: float
    t12: float
    t22: float


def make_stiffness(spec: Spec):
    """Return `kernel(contact) -> Stiffness`."""
    return by_friction(spec, make_frictionless_stiffness, make_frictional_stiffness)


def make_frictionless_stiffness(spec: Spec):
    """Return the same kernel for contacts without friction."""
    bilateral, bounded = row_terms(spec).bilateral, row_terms(spec).bounded

    def frictionless_stiffness(contact):
        if bounded:
            if contact.motor == 1:
                n = contact.scale * contact.start_n - contact.stiff_n * contact.velocity_n
                if abs(n) > contact.most:
                    return Stiffness(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if bilateral:
            if contact.bilateral == 1:
                return Stiffness(contact.stiff_n, 0.0, 0.0, 0.0, 0.0, 0.0)
        n = contact.scale * contact.start_n - contact.stiff_n * contact.velocity_n
        return Stiffness((contact.stiff_n if n > 0.0 else 0.0), 0.0, 0.0, 0.0, 0.0, 0.0)

    return kernel(frictionless_stiffness, spec)


def make_frictional_stiffness(spec: Spec):
    """Return the same kernel for contacts with friction."""

    def stiffness(contact):
        n = contact.scale * contact.start_n - contact.stiff_n * contact.velocity_n
        e_n = contact.stiff_n
        e_t, mu = contact.stiff_t, contact.mu
        one = contact.start_1 - e_t * contact.velocity_1
        two = contact.start_2 - e_t * contact.velocity_2
        r = sqrt(one * one + two * two)
        if r <= mu * n:
            return Stiffness(e_n, 0.0, 0.0, e_t, 0.0, e_t)
        weight = mu * e_n / e_t
        n = (n + weight * r) / (1.0 + weight * mu)
        if n <= 0.0:
            return Stiffness(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        # Along the ray of the cone's surface, and around it.
        u, v = one / r, two / r
        ray = e_n / (1.0 + weight * mu)
        around = e_t * mu * n / r
        along = mu * mu * ray - around
        return Stiffness(
            ray,
            mu * ray * u,
            mu * ray * v,
            around + along * u * u,
            along * u * v,
            around + along * v * v,
        )

    return kernel(stiffness, spec)


def make_fill_rows(spec: Spec):
    """Return `kernel(contact, rows)`: those of A and of B (n, t1, t2), as J has them."""
    return by_friction(spec, _make_fill_normal, _make_fill_block)


def _make_fill_block(spec: Spec):
    coupled = row_terms(spec).coupled

    def fill(rows, along, x, y, z, contact):
        a, b = OF_A + along, OF_B + along
        rows[a, X], rows[a, Y], rows[a, Z] = -x, -y, -z
        rows[a, WX] = contact.raz * y - contact.ray * z
        rows[a, WY] = contact.rax * z - contact.raz * x
        rows[a, WZ] = contact.ray * x - contact.rax * y
        rows[b, X], rows[b, Y], rows[b, Z] = x, y, z
        rows[b, WX] = contact.rby * z - contact.rbz * y
        rows[b, WY] = contact.rbz * x - contact.rbx * z
        rows[b, WZ] = contact.rbx * y - contact.rby * x
        if coupled:
            turn = contact.patch_x * x + contact.patch_y * y + contact.patch_z * z
            nx, ny, nz = contact.nx * turn, contact.ny * turn, contact.nz * turn
            rows[a, WX] -= nx
            rows[a, WY] -= ny
            rows[a, WZ] -= nz
            rows[b, WX] += nx
            rows[b, WY] += ny
            rows[b, WZ] += nz

    fill = kernel(fill, spec)

    def fill_block(contact, rows):
        fill(rows, N, contact.nx, contact.ny, contact.nz, contact)
        fill(rows, T1, contact.t1x, contact.t1y, contact.t1z, contact)
        fill(rows, T2, contact.t2x, contact.t2y, contact.t2z, contact)

    return kernel(fill_block, spec)


def _make_fill_normal(spec: Spec):
    torque = row_terms(spec).levers

    def fill_normal(contact, rows):
        rows[OF_A, X], rows[OF_A, Y], rows[OF_A, Z] = -contact.nx, -contact.ny, -contact.nz
        rows[OF_B, X], rows[OF_B, Y], rows[OF_B, Z] = contact.nx, contact.ny, contact.nz
        if torque:
            rows[OF_A, WX], rows[OF_A, WY] = -contact.lever_ax, -contact.lever_ay
            rows[OF_A, WZ] = -contact.lever_az
            rows[OF_B, WX], rows[OF_B, WY] = contact.lever_bx, contact.lever_by
            rows[OF_B, WZ] = contact.lever_bz

    return kernel(fill_normal, spec)
