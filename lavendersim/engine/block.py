"""Contact blocks: what a frictional contact is to the solver. Frame, levers and its 3x3 of W.

    v = (v_B + omega_B x r_B) - (v_A + omega_A x r_A)        relative velocity, world axes
    p = n lambda_n + t1 lambda_1 + t2 lambda_2               impulse on B, world axes; A gets -p
Levers end on each body's own surface, so that a speculative contact has the levers it
will have when the surfaces meet. Friction at two points, phi apart along n, is a couple
phi lambda_t that nobody bears. Where both bodies move both levers therefore end in the middle: of
surfaces that give way and overlap by what they are indented, and, with contacts at the middle of
the step, of two that touch and that nothing restrains. So friction keeps angular momentum.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from .collide.nearest_image import place_beside
from .compile import inner, kernel
from .effects import made_once
from .row_terms import make_is_soft, row_terms
from .spec import Spec
from .step_terms import step_terms
from .tangents import first_tangent, second_tangent
from .vectors import Vec3, cross, dot, plus_scaled

t1_of, t2_of = inner(first_tangent), inner(second_tangent)


@inner
def set_tangents(contact):
    """Fill t1, t2 such that (n, t1, t2) is right-handed and orthonormal."""
    x, y, z = contact.nx, contact.ny, contact.nz
    side = 1.0 if z >= 0.0 else -1.0
    contact.t1x, contact.t1y, contact.t1z = t1_of(x, y, z, side)
    contact.t2x, contact.t2y, contact.t2z = t2_of(x, y, z, side)


@inner
def inertia_response(v, x, y, z):
    """World inverse inertia of the body of `v` applied to a vector."""
    return (
        v.jxx * x + v.jxy * y + v.jxz * z,
        v.jxy * x + v.jyy * y + v.jyz * z,
        v.jxz * x + v.jyz * y + v.jzz * z,
    )


@inner
def point_response(v, inv_m, r, p):
    """Velocity that a unit impulse p at r gives to the body's point r [1/kg]."""
    turn = cross(r, p)
    wx, wy, wz = inertia_response(v, turn.x, turn.y, turn.z)
    return Vec3(
        inv_m * p.x + wy * r.z - wz * r.y,
        inv_m * p.y + wz * r.x - wx * r.z,
        inv_m * p.z + wx * r.y - wy * r.x,
    )


@inner
def block_response(contact, va, vb, x, y, z):
    """Relative velocity that a unit impulse (x, y, z) on B, and its opposite on A, gives [1/kg]."""
    p = Vec3(x, y, z)
    a = b = Vec3(0.0, 0.0, 0.0)
    if contact.inv_m_a > 0.0:
        a = point_response(va, contact.inv_m_a, Vec3(contact.rax, contact.ray, contact.raz), p)
    if contact.inv_m_b > 0.0:
        b = point_response(vb, contact.inv_m_b, Vec3(contact.rbx, contact.rby, contact.rbz), p)
    return a.x + b.x, a.y + b.y, a.z + b.z


@inner
def largest_response(contact):
    """Return a bound on the largest eigenvalue of the contact's 3x3 of W, gamma included [1/kg].

    That of [[k_n + gamma, c], [c, k_t]], c the length of the column between normal and tangents.
    """
    k_n, k_t = 1.0 / contact.inv_k, contact.k_t
    half_gap = 0.5 * (k_n - k_t)
    across = contact.k_n1 * contact.k_n1 + contact.k_n2 * contact.k_n2
    return 0.5 * (k_n + k_t) + sqrt(half_gap * half_gap + across)


@inner
def coupled_response(v, inv_m, r, p, couple):
    """The same as `point_response` of a contact with a couple (n, e): also turned by e . p."""
    n, e = couple
    turn = plus_scaled(cross(r, p), dot(e, p), n)
    wx, wy, wz = inertia_response(v, turn.x, turn.y, turn.z)
    spin = wx * n.x + wy * n.y + wz * n.z
    return Vec3(
        inv_m * p.x + wy * r.z - wz * r.y + spin * e.x,
        inv_m * p.y + wz * r.x - wx * r.z + spin * e.y,
        inv_m * p.z + wx * r.y - wy * r.x + spin * e.z,
    )


@inner
def couple_of(contact):
    """Return n and e of a contact whose friction acts elsewhere than at its point."""
    n = Vec3(contact.nx, contact.ny, contact.nz)
    return n, Vec3(contact.patch_x, contact.patch_y, contact.patch_z)


def make_block_response(spec: Spec):
    """Return `kernel(contact, va, vb, x, y, z) -> (x, y, z)`, see `block_response`."""
    if not row_terms(spec).coupled:
        return block_response

    def coupled_block_response(contact, va, vb, x, y, z):
        p, couple = Vec3(x, y, z), couple_of(contact)
        ra = Vec3(contact.rax, contact.ray, contact.raz)
        rb = Vec3(contact.rbx, contact.rby, contact.rbz)
        a = coupled_response(va, contact.inv_m_a, ra, p, couple)
        b = coupled_response(vb, contact.inv_m_b, rb, p, couple)
        return a.x + b.x, a.y + b.y, a.z + b.z

    return kernel(coupled_block_response, spec)


def make_relative_velocity(spec: Spec):
    """Return `kernel(contact, va, vb) -> (x, y, z)`, of B's surface relative to A's [m/s]."""
    if not row_terms(spec).frictional:
        return None

    def relative_velocity(contact, va, vb):
        return (
            vb.vx + vb.wy * contact.rbz - vb.wz * contact.rby
            - va.vx - va.wy * contact.raz + va.wz * contact.ray,
            vb.vy + vb.wz * contact.rbx - vb.wx * contact.rbz
            - va.vy - va.wz * contact.rax + va.wx * contact.raz,
            vb.vz + vb.wx * contact.rby - vb.wy * contact.rbx
            - va.vz - va.wx * contact.ray + va.wy * contact.rax,
        )  # fmt: skip

    at_point = kernel(relative_velocity, spec)
    if not row_terms(spec).coupled:
        return at_point

    def coupled_velocity(contact, va, vb):
        x, y, z = at_point(contact, va, vb)
        spin = contact.nx * (vb.wx - va.wx)
        spin += contact.ny * (vb.wy - va.wy) + contact.nz * (vb.wz - va.wz)
        return x + spin * contact.patch_x, y + spin * contact.patch_y, z + spin * contact.patch_z

    return kernel(coupled_velocity, spec)


def make_slip_velocity(spec: Spec):
    """Return `kernel(contact, va, vb) -> (v_n, v_1, v_2)`, along its axes [m/s].

    With the velocities that surfaces have in their bodies; what gives way along its surface by the
    contact's impulse is no slip.
    """
    if not row_terms(spec).frictional:
        return None
    shifted, yielding = row_terms(spec).shifted, row_terms(spec).yielding
    relative_velocity = make_relative_velocity(spec)

    def slip_velocity(contact, va, vb):
        x, y, z = relative_velocity(contact, va, vb)
        v_n = contact.nx * x + contact.ny * y + contact.nz * z
        v_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        v_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        if shifted:
            v_1 += contact.surface_1
            v_2 += contact.surface_2
        if yielding:
            v_1 += contact.gamma_t * contact.lambda_1
            v_2 += contact.gamma_t * contact.lambda_2
        return v_n, v_1, v_2

    return kernel(slip_velocity, spec)


def make_apply_vector(spec: Spec):
    """Return `kernel(contact, va, vb, px, py, pz)`: + on B, - on A, world axes [N s]."""
    if not row_terms(spec).frictional:
        return None

    def apply_vector(contact, va, vb, px, py, pz):
        if contact.inv_m_a > 0.0:
            va.vx -= px * contact.inv_m_a
            va.vy -= py * contact.inv_m_a
            va.vz -= pz * contact.inv_m_a
            rx, ry, rz = contact.rax, contact.ray, contact.raz
            x, y, z = inertia_response(va, ry * pz - rz * py, rz * px - rx * pz, rx * py - ry * px)
            va.wx -= x
            va.wy -= y
            va.wz -= z
        if contact.inv_m_b > 0.0:
            vb.vx += px * contact.inv_m_b
            vb.vy += py * contact.inv_m_b
            vb.vz += pz * contact.inv_m_b
            rx, ry, rz = contact.rbx, contact.rby, contact.rbz
            x, y, z = inertia_response(vb, ry * pz - rz * py, rz * px - rx * pz, rx * py - ry * px)
            vb.wx += x
            vb.wy += y
            vb.wz += z

    at_point = kernel(apply_vector, spec)
    if not row_terms(spec).coupled:
        return at_point

    def apply_coupled(contact, va, vb, px, py, pz):
        at_point(contact, va, vb, px, py, pz)
        turn = contact.patch_x * px + contact.patch_y * py + contact.patch_z * pz
        nx, ny, nz = contact.nx * turn, contact.ny * turn, contact.nz * turn
        if contact.inv_m_a > 0.0:
            x, y, z = inertia_response(va, nx, ny, nz)
            va.wx -= x
            va.wy -= y
            va.wz -= z
        if contact.inv_m_b > 0.0:
            x, y, z = inertia_response(vb, nx, ny, nz)
            vb.wx += x
            vb.wy += y
            vb.wz += z

    return kernel(apply_coupled, spec)


def make_complete_block(spec: Spec):
    """Return `kernel(contact, body_a, body_b, va, vb, pair) -> k_n`: frame, levers and the 3x3."""
    moving_surface, surface_velocity = made_once(spec, "surface_velocity")
    swept, shifted = row_terms(spec).swept, row_terms(spec).shifted
    stretched, stretch_tangents = made_once(spec, "stretch_tangents")
    response, beside = make_block_response(spec), place_beside(spec)
    springs: bool = row_terms(spec).elastic
    is_soft: Any = make_is_soft(spec) if springs else None
    centred = step_terms(spec).centred

    def complete_block(contact, body_a, body_b, va, vb, pair):
        half = 0.5 * contact.phi
        if springs:
            if is_soft(pair) and body_a.inv_m > 0.0 and body_b.inv_m > 0.0:
                half = 0.0
        if centred:
            if contact.lasts == 1 and body_a.inv_m > 0.0 and body_b.inv_m > 0.0:
                half = 0.0
        x, y, z = contact.nx * half, contact.ny * half, contact.nz * half
        contact.rax = contact.x - x - body_a.x
        contact.ray = contact.y - y - body_a.y
        contact.raz = contact.z - z - body_a.z
        b = beside(body_a, body_b)
        contact.rbx = contact.x + x - b.x
        contact.rby = contact.y + y - b.y
        contact.rbz = contact.z + z - b.z
        if swept:
            contact.rbx -= contact.tangential_x
            contact.rby -= contact.tangential_y
            contact.rbz -= contact.tangential_z
        set_tangents(contact)
        if stretched:
            stretch_tangents(contact, body_a, body_b, pair)
        contact.mu = pair.friction
        contact.lambda_1, contact.lambda_2 = 0.0, 0.0
        x, y, z = response(contact, va, vb, contact.nx, contact.ny, contact.nz)
        k_n = contact.nx * x + contact.ny * y + contact.nz * z
        contact.k_n1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        contact.k_n2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        x, y, z = response(contact, va, vb, contact.t1x, contact.t1y, contact.t1z)
        k_11 = contact.t1x * x + contact.t1y * y + contact.t1z * z
        k_12 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        x, y, z = response(contact, va, vb, contact.t2x, contact.t2y, contact.t2z)
        k_22 = contact.t2x * x + contact.t2y * y + contact.t2z * z
        scale = 1.0 / (k_11 * k_22 - k_12 * k_12)
        contact.i_11, contact.i_12, contact.i_22 = k_22 * scale, -k_12 * scale, k_11 * scale
        if shifted:
            contact.surface_1, contact.surface_2 = 0.0, 0.0
        if moving_surface:
            surface_velocity(contact, body_a, body_b)
        half_gap = 0.5 * (k_11 - k_22)
        contact.k_t = 0.5 * (k_11 + k_22) + sqrt(half_gap * half_gap + k_12 * k_12)
        return k_n

    return kernel(complete_block, spec)
